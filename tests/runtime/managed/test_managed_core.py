"""The implementation of lifecycle nodes, as its callers use it."""

from __future__ import annotations

import pytest

from graphflow import LifecycleNode, LifecycleState, TransitionFailed, TransitionRefused, service, timer
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.runtime.managed.managed_core import ManagedCore
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph


class Worker(LifecycleNode):
    """Ticks while it is active."""

    ticks = 0
    refuses = False

    async def on_activate(self) -> None:
        if self.refuses:
            raise TransitionRefused("too tired")

    @timer(1.0)
    async def tick(self) -> None:
        self.ticks += 1

    @service(Trigger, "hail")
    async def hail(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


def managed(node: LifecycleNode) -> ManagedCore:
    core = core_of(node)
    assert isinstance(core, ManagedCore)
    return core


@pytest.mark.parametrize("target", ["UNCONFIGURED", "INACTIVE", "ACTIVE"])
async def test_a_node_is_brought_to_its_target(graph: Graph, target: str) -> None:
    """Before it counts as started; each primary state is reported."""
    node = Worker()
    core, told = managed(node), []
    core.target = LifecycleState[target]
    core.on_state = lambda state: told.append(state.label)
    await graph.start(node)
    assert node.lifecycle_state is core.target
    assert told == ["unconfigured", "inactive", "active"][: core.target.level + 1]
    await graph.clock.advance(1.5)
    assert node.ticks == (target == "ACTIVE")


async def test_a_node_that_does_not_reach_its_target(graph: Graph) -> None:
    """It does not start, and no resources stay open."""
    node = Worker()
    node.refuses = True
    managed(node).target = LifecycleState.ACTIVE
    with pytest.raises(
        TransitionFailed, match="/worker could not activate: on_activate refused: too tired; it is inac"
    ):
        await graph.start(node)
    assert not node.is_running


async def test_handlers_can_be_looked_at_after_a_rest(graph: Graph) -> None:
    """The search for deadlocks goes by the list of runners, in which those that rest may be missing."""
    node = Worker()
    await graph.start(node)
    core = managed(node)
    await node.trigger_configure()
    node.create_subscription(Trigger.Request, "more", lambda message: None)  # which tidies the list
    await node.trigger_activate()
    assert {"tick", "hail"} <= {runner.spec.handler for runner in core.runners}


async def test_groups_know_their_members_after_a_rest(graph: Graph) -> None:
    """A handler that rests takes no slot, and queues for one again afterwards."""

    class Grouped(Worker):
        default_group = None

    node = Grouped()
    await graph.start(node)
    for _ in range(2):
        for step in ("configure", "activate", "deactivate", "cleanup"):
            await getattr(node, f"trigger_{step}")()
    await node.trigger_configure()
    await node.trigger_activate()
    await graph.clock.advance(1.0)
    assert node.ticks == 1
    members = [runner for group in core_of(node).groups.by_name.values() for runner in group.members]
    assert len(members) == len(set(map(id, members)))


@pytest.mark.parametrize("target", [None, LifecycleState.ACTIVE])
@pytest.mark.parametrize("is_active", [True, False])
async def test_a_node_that_brings_itself_up(
    graph: Graph, target: LifecycleState | None, caplog: pytest.LogCaptureFixture, *, is_active: bool
) -> None:
    """It works as one that others bring up: its handlers begin after `on_start`, and its tasks go on."""

    class Ready(Worker):
        counted = 0

        async def on_start(self) -> None:
            await self.trigger_configure()
            if is_active:
                await self.trigger_activate()
            assert self.ticks == 0

        async def on_configure(self) -> None:
            self.spawn(self.count)

        async def count(self) -> None:
            async for _ in self.clock.every(1.0):
                self.counted += 1

    caplog.set_level("INFO")
    node = Ready()
    managed(node).target = target
    await graph.start(node)
    told = [text for text in caplog.messages if "graphflow lifecycle set" in text]
    assert [text.partition(",")[0] for text in told] == (
        [] if is_active or target is not None else ["inactive: graphflow lifecycle set /ready activate"]
    )
    await graph.clock.advance(1.0)
    assert (node.ticks, node.counted) == (int(is_active or target is not None), 2)
    if target is None and not is_active:
        await node.trigger_activate()
    await node.trigger_deactivate()
    await graph.clock.advance(1.0)
    assert (node.ticks, node.counted) == (int(is_active or target is not None), 3)
