"""The life of a managed node: ROS 2's states, and the transitions between them as one table.

A node rests in a *primary* state, and passes through a *transition* state while one of its hooks runs:

    unconfigured --configure--> configuring --> inactive --activate--> activating --> active
         ^                                       |    ^                                  |
         +------------------ cleaningup <--cleanup    +---- deactivating <--deactivate---+

    shutdown, from any of the three:  shuttingdown --> finalized

A hook that returns has succeeded and the node arrives. One that refuses leads back to where the node came from, except
from `shuttingdown`, which always ends in `finalized`. One that fails in any other way leads to `errorprocessing`, and
from there to `unconfigured` if the node recovers, else to `finalized`.

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
        """What ROS 2 calls it: `unconfigured`."""
        return self.name.lower()

    @property
    def is_primary(self) -> bool:
        """Whether a node rests in it, rather than passes through."""
        return self <= LifecycleState.FINALIZED

    @property
    def level(self) -> int:
        """How far up a primary state is: 0 for nothing set up, 1 for configured, 2 for active."""
        return {LifecycleState.INACTIVE: 1, LifecycleState.ACTIVE: 2}.get(self, 0)

    @property
    def hook(self) -> str:
        """The method that runs in a transition state."""
        return _HOOKS[self]


class Outcome(IntEnum):
    """How a hook has ended, with the numbers of lifecycle_msgs/msg/Transition."""

    SUCCESS = 97
    FAILURE = 98
    ERROR = 99

    @property
    def label(self) -> str:
        """The label of the transition that follows: `transition_success`."""
        return f"transition_{self.name.lower()}"


class Transition(NamedTuple):
    """One arrow of the picture."""

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
    """The transitions that start in a state."""
    return [transition for transition in TRANSITIONS if transition.start is state]


def asked(state: LifecycleState, wanted: int | str) -> Transition | None:
    """The transition that a request means, by id or by label; None where there is none such from here.

    As in ROS 2, a label such as `shutdown` means the transition of that label from this state, and an id one alone.
    Only those from primary states can be asked for: the others are how hooks end.
    """
    if not state.is_primary:
        return None
    return next((t for t in available(state) if wanted in (t.id, t.label)), None)


def after(state: LifecycleState, outcome: Outcome) -> Transition:
    """The transition that follows when the hook of a transition state has ended."""
    return next(t for t in available(state) if t.label == outcome.label)


def path(state: LifecycleState, target: LifecycleState) -> list[str]:
    """The labels of the transitions that lead from one resting state to another: `configure`, `activate`.

    Returns:
        Nothing when the node is there, or when no way leads there, as from `finalized`.
    """
    if LifecycleState.FINALIZED in (state, target):
        return ["shutdown"] if target is LifecycleState.FINALIZED is not state else []
    up, down = ("configure", "activate"), ("cleanup", "deactivate")
    if state.level <= target.level:
        return list(up[state.level : target.level])
    return list(reversed(down[target.level : state.level]))
