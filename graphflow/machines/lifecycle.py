"""The life cycle of a managed node: ROS 2's states, and the transitions between them as one table.

A node rests in a *primary* state, and passes through a *transition* state while one of its hooks runs:

    unconfigured --configure--> configuring --> inactive --activate--> activating --> active
         ^                                       |    ^                                  |
         +------------------ cleaningup <--cleanup    +---- deactivating <--deactivate---+

    shutdown, from any of the three:  shuttingdown --> finalized

SUCCESS of a hook completes the transition. FAILURE leads back to the state before it, except in `shuttingdown`, which
always ends in `finalized`. ERROR leads to `errorprocessing`, and from there to `unconfigured` if the node recovers,
else to `finalized`.

Source: rcl_lifecycle default_state_machine.c, for states, ids, labels and their order; lifecycle_msgs State and
Transition.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class LifecycleState(IntEnum):
    """The states of lifecycle_msgs/msg/State, in the order in which ROS 2 lists them."""

    UNKNOWN = 0
    UNCONFIGURED = 1
    INACTIVE = 2
    ACTIVE = 3
    FINALIZED = 4
    CONFIGURING = 10
    CLEANINGUP = 11
    SHUTTINGDOWN = 12
    ACTIVATING = 13
    DEACTIVATING = 14
    ERRORPROCESSING = 15

    @property
    def label(self) -> str:
        """Label of the state in ROS 2: `unconfigured`."""
        return self.name.lower()

    @property
    def is_primary(self) -> bool:
        """Whether a node rests in the state rather than passes through it."""
        return self <= LifecycleState.FINALIZED

    @property
    def level(self) -> int:
        """Height of a primary state: 0 for nothing set up, 1 for configured, 2 for active."""
        return {LifecycleState.INACTIVE: 1, LifecycleState.ACTIVE: 2}.get(self, 0)

    @property
    def hook(self) -> str:
        """Name of the method that runs in a transition state."""
        return _HOOKS[self]


class Outcome(IntEnum):
    """The outcome of a hook, with the numbers of lifecycle_msgs/msg/Transition."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    @property
    def label(self) -> str:
        """Label of the transition that follows: `transition_success`."""
        return f"transition_{self.name.lower()}"


class Transition(NamedTuple):
    """One transition of the diagram above."""

    id: int
    label: str
    start: LifecycleState
    goal: LifecycleState


_S = LifecycleState
_HOOKS = {
    _S.CONFIGURING: "on_configure",
    _S.CLEANINGUP: "on_cleanup",
    _S.SHUTTINGDOWN: "on_shutdown",
    _S.ACTIVATING: "on_activate",
    _S.DEACTIVATING: "on_deactivate",
    _S.ERRORPROCESSING: "on_error",
}

TRANSITIONS = (
    Transition(1, "configure", _S.UNCONFIGURED, _S.CONFIGURING),
    Transition(10, "transition_success", _S.CONFIGURING, _S.INACTIVE),
    Transition(11, "transition_failure", _S.CONFIGURING, _S.UNCONFIGURED),
    Transition(12, "transition_error", _S.CONFIGURING, _S.ERRORPROCESSING),
    Transition(2, "cleanup", _S.INACTIVE, _S.CLEANINGUP),
    Transition(20, "transition_success", _S.CLEANINGUP, _S.UNCONFIGURED),
    Transition(21, "transition_failure", _S.CLEANINGUP, _S.INACTIVE),
    Transition(22, "transition_error", _S.CLEANINGUP, _S.ERRORPROCESSING),
    Transition(3, "activate", _S.INACTIVE, _S.ACTIVATING),
    Transition(30, "transition_success", _S.ACTIVATING, _S.ACTIVE),
    Transition(31, "transition_failure", _S.ACTIVATING, _S.INACTIVE),
    Transition(32, "transition_error", _S.ACTIVATING, _S.ERRORPROCESSING),
    Transition(4, "deactivate", _S.ACTIVE, _S.DEACTIVATING),
    Transition(40, "transition_success", _S.DEACTIVATING, _S.INACTIVE),
    Transition(41, "transition_failure", _S.DEACTIVATING, _S.ACTIVE),
    Transition(42, "transition_error", _S.DEACTIVATING, _S.ERRORPROCESSING),
    Transition(5, "shutdown", _S.UNCONFIGURED, _S.SHUTTINGDOWN),
    Transition(6, "shutdown", _S.INACTIVE, _S.SHUTTINGDOWN),
    Transition(7, "shutdown", _S.ACTIVE, _S.SHUTTINGDOWN),
    Transition(50, "transition_success", _S.SHUTTINGDOWN, _S.FINALIZED),
    Transition(51, "transition_failure", _S.SHUTTINGDOWN, _S.FINALIZED),
    Transition(52, "transition_error", _S.SHUTTINGDOWN, _S.ERRORPROCESSING),
    Transition(60, "transition_success", _S.ERRORPROCESSING, _S.UNCONFIGURED),
    Transition(61, "transition_failure", _S.ERRORPROCESSING, _S.FINALIZED),
    Transition(62, "transition_error", _S.ERRORPROCESSING, _S.FINALIZED),
)
"""All transitions, in the order in which ROS 2 lists them."""


def available(state: LifecycleState) -> list[Transition]:
    """Return the transitions that start in a state."""
    return [transition for transition in TRANSITIONS if transition.start is state]


def asked(state: LifecycleState, wanted: int | str) -> Transition | None:
    """Return the transition that a request selects, by id or by label; None if no such one starts here.

    As in ROS 2, a label such as `shutdown` selects the transition of that label from this state, whereas an id is
    unique. Only transitions from primary states can be requested: the others are the outcomes of hooks.
    """
    if not state.is_primary:
        return None
    return next((t for t in available(state) if wanted in (t.id, t.label)), None)


def after(state: LifecycleState, outcome: Outcome) -> Transition:
    """Return the transition that follows the outcome of a transition state's hook."""
    return next(t for t in available(state) if t.label == outcome.label)


def path(state: LifecycleState, target: LifecycleState) -> list[str]:
    """Return the labels of the transitions from one primary state to another: `configure`, `activate`.

    Returns:
        An empty list if both are the same, or if no way leads there, as from `finalized`.
    """
    if LifecycleState.FINALIZED in (state, target):
        return ["shutdown"] if target is LifecycleState.FINALIZED is not state else []
    up, down = ("configure", "activate"), ("cleanup", "deactivate")
    if state.level <= target.level:
        return list(up[state.level : target.level])
    return list(reversed(down[target.level : state.level]))


def commands(node: str, state: LifecycleState, target: LifecycleState = LifecycleState.ACTIVE) -> str:
    """Return the command lines that bring a node from its state to another; empty if there are none.

    Args:
        node: The node's full name.
    """
    steps = path(state, target) if state.is_primary else []
    return " && ".join(f"graphflow lifecycle set {node} {step}" for step in steps)
