"""States of lifecycle nodes, read and changed from outside."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from graphflow import LifecycleNode, Node
from graphflow.errors import CallError
from graphflow.introspect.graph_view import View
from graphflow.introspect.lifecycles import ROUNDS, change, idle, managed_nodes, state, transitions
from graphflow.msgs.lifecycle_msgs.msg import State, Transition, TransitionDescription
from graphflow.msgs.lifecycle_msgs.srv import ChangeState
from graphflow.testing import Graph
from tests.cases import slow


class Asked(View):
    """A view that answers every call, and records them."""

    def __init__(self, **answer: Any) -> None:
        self.answer, self.asked = SimpleNamespace(**answer), list[tuple[str, str, Any]]()

    def call(self, name: str, type_name: str, request: Any, timeout: float = 10.0, *, plain: bool = False) -> Any:
        self.asked.append((name, type_name.rpartition("/")[2], request))
        return self.answer


def test_what_is_asked() -> None:
    """The services of ROS 2."""
    active, deactivate = State(label="active"), Transition(id=4, label="deactivate")
    way = TransitionDescription(transition=deactivate)
    view = Asked(current_state=active, available_transitions=[way], success=True)
    assert state(view, "/lived", 1.0) is active
    assert transitions(view, "/lived", 1.0) == transitions(view, "/lived", 1.0, everything=True) == [way]
    assert change(view, "/lived", deactivate, 1.0) is True
    assert [(name, type_) for name, type_, _ in view.asked] == [
        ("/lived/get_state", "GetState"),
        ("/lived/get_available_transitions", "GetAvailableTransitions"),
        ("/lived/get_transition_graph", "GetAvailableTransitions"),
        ("/lived/change_state", "ChangeState"),
    ]
    assert view.asked[-1][2].transition.id == 4


async def test_who_has_a_life_cycle(graph: Graph) -> None:
    """Lifecycle nodes have their own service to change the state; such a service elsewhere does not count."""
    plain = Node("plain")
    plain.create_service(ChangeState, "/elsewhere/change_state", lambda _: ChangeState.Response())
    await graph.start(LifecycleNode("lived"), plain)
    assert managed_nodes(plain.context.cache) == ["/lived"]


@pytest.mark.parametrize(
    ("number", "told"),
    [
        (
            1,
            "unconfigured, not active: graphflow lifecycle set /lived configure && "
            "graphflow lifecycle set /lived activate",
        ),
        (2, "inactive, not active: graphflow lifecycle set /lived activate"),
        (3, ""),
        (99, ""),
    ],
)
async def test_nodes_that_are_not_active(graph: Graph, number: int, told: str) -> None:
    """Each is told with the next step; an active node and an unknown state are not."""
    await graph.start(node := LifecycleNode("lived"))
    view = Asked(current_state=State(id=number))
    view.cache = node.context.cache
    assert idle(view, 1.0).hints == ([f"/lived is {told}"] if told else [])
    assert idle(view, 1.0).unknown == (["/lived"] if number == 99 else [])
    assert idle(view, 1.0, {"/lived"}) == idle(view, 1.0)
    assert idle(view, 1.0, {"/other"}) == ([], [])


@slow
async def test_many_silent_nodes(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """They cost a bounded time together and are all named, and hidden nodes are not asked at all."""
    names = [f"silent{i}" for i in range(ROUNDS + 5)]
    nodes = [LifecycleNode(name) for name in ("_hidden", *names)]
    await graph.start(*nodes)
    now = 0.0
    asked: list[str] = []

    def call(name: str, *_: Any) -> Any:
        nonlocal now
        now += 1.0
        asked.append(name)
        raise CallError(name)

    view = Asked()
    view.cache = nodes[0].context.cache
    monkeypatch.setattr(view, "call", call)
    monkeypatch.setattr("graphflow.introspect.lifecycles.time", SimpleNamespace(monotonic=lambda: now))
    assert idle(view, 1.0) == ([], sorted(f"/{name}" for name in names))
    assert len(asked) == ROUNDS
    assert not any("_hidden" in name for name in asked)
