"""The states that a goal may go through, written down from rcl_action goal_state_machine.c: an oracle for our table."""

from __future__ import annotations

from graphflow import GoalStatus

NEXT = {
    GoalStatus.ACCEPTED: {GoalStatus.EXECUTING, GoalStatus.CANCELING},
    GoalStatus.EXECUTING: {GoalStatus.CANCELING, GoalStatus.SUCCEEDED, GoalStatus.ABORTED},
    GoalStatus.CANCELING: {GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.CANCELED},
}
"""By state: those that may follow. No others have any."""
