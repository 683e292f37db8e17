"""The table of a managed node's life."""

from __future__ import annotations

import pytest

from graphflow.machines.lifecycle import (
    TRANSITIONS,
    LifecycleState,
    Outcome,
    after,
    asked,
    available,
    commands,
    path,
)
from graphflow.msgs.lifecycle_msgs.msg import State, Transition

PRIMARY = [state for state in LifecycleState if state.is_primary]
PASSING = [state for state in LifecycleState if not state.is_primary]


@pytest.mark.parametrize("state", LifecycleState)
def test_states_have_the_numbers_of_ros(state: LifecycleState) -> None:
    """As lifecycle_msgs/msg/State has them."""
    prefix = "PRIMARY_STATE" if state.is_primary else "TRANSITION_STATE"
    assert getattr(State, f"{prefix}_{state.name}") == state


def test_transitions_have_the_numbers_of_ros() -> None:
    """Each constant of lifecycle_msgs/msg/Transition but for `create` and `destroy`, which no table of ROS has."""
    names = {
        f"{t.start.name}_SHUTDOWN" if t.label == "shutdown" else t.label.upper(): t.id
        for t in TRANSITIONS
        if t.start.is_primary
    }
    for t in TRANSITIONS:
        if not t.start.is_primary:
            hook = "on_error" if t.start is LifecycleState.ERRORPROCESSING else t.start.hook
            names[f"{hook}_{t.label.removeprefix('transition_')}".upper()] = t.id
    names |= {f"CALLBACK_{outcome.name}": outcome for outcome in Outcome}
    known = {
        name.removeprefix("TRANSITION_"): getattr(Transition, name)
        for name in dir(Transition)
        if name.startswith("TRANSITION_")
    }
    assert names == {k: v for k, v in known.items() if k not in ("CREATE", "DESTROY")}


@pytest.mark.parametrize("state", PASSING)
def test_each_hook_leads_somewhere_however_it_ends(state: LifecycleState) -> None:
    """Three ways out; only failing outright leads to another state that is passed through."""
    goals = {outcome: after(state, outcome).goal for outcome in Outcome}
    assert len(available(state)) == 3
    assert goals[Outcome.SUCCESS].is_primary
    assert goals[Outcome.FAILURE].is_primary
    if state is not LifecycleState.ERRORPROCESSING:
        assert goals[Outcome.ERROR] is LifecycleState.ERRORPROCESSING


@pytest.mark.parametrize("start", ["unconfigured", "inactive", "active"])
def test_a_refusal_leads_back(start: str) -> None:
    """Except from a shutdown."""
    state = LifecycleState[start.upper()]
    for transition in available(state):
        back = after(transition.goal, Outcome.FAILURE).goal
        assert back is (LifecycleState.FINALIZED if transition.label == "shutdown" else state)


@pytest.mark.parametrize(
    ("state", "wanted", "number"),
    [
        ("UNCONFIGURED", "configure", 1),
        ("UNCONFIGURED", 1, 1),
        ("UNCONFIGURED", "activate", None),
        ("UNCONFIGURED", 3, None),
        ("UNCONFIGURED", 0, None),
        ("UNCONFIGURED", "", None),
        ("INACTIVE", "shutdown", 6),
        ("ACTIVE", "shutdown", 7),
        ("ACTIVE", 5, None),
        ("CONFIGURING", "transition_success", None),
        ("CONFIGURING", 10, None),
        ("FINALIZED", "configure", None),
    ],
)
def test_what_is_asked_for(state: str, wanted: int | str, number: int | None) -> None:
    """A label or an id counts from the state that the node is in, and nobody outside can end a hook."""
    found = asked(LifecycleState[state], wanted)
    assert (found and found.id) == number


@pytest.mark.parametrize("start", PRIMARY[1:])
@pytest.mark.parametrize("target", PRIMARY[1:])
def test_the_path_leads_there(start: LifecycleState, target: LifecycleState) -> None:
    """Each step is one that the state before it allows; from `finalized` no way leads anywhere."""
    state = start
    for label in path(start, target):
        transition = asked(state, label)
        assert transition is not None
        state = after(transition.goal, Outcome.SUCCESS).goal
    assert state is (start if start is LifecycleState.FINALIZED else target)


def test_commands() -> None:
    """Each line is one that a shell takes; a hook that runs, and an end, leave nothing to type."""
    both = "graphflow lifecycle set /camera configure && graphflow lifecycle set /camera activate"
    assert commands("/camera", LifecycleState.UNCONFIGURED) == both
    down = commands("/camera", LifecycleState.ACTIVE, LifecycleState.INACTIVE)
    assert down == "graphflow lifecycle set /camera deactivate"
    assert [commands("/camera", s) for s in (LifecycleState.ACTIVATING, LifecycleState.FINALIZED)] == ["", ""]


def test_labels_are_those_of_ros() -> None:
    """Lower case, in one word."""
    assert [state.label for state in PASSING][1:3] == ["cleaningup", "shuttingdown"]
