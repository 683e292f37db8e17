"""A class's declarations at work: parameters that are followed, handlers that are attached."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import DeclarationError, Node, Param, ParameterError, subscription, timer
from graphflow.msgs.rcl_interfaces.srv import SetParameters
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.declarations import binding
from graphflow.testing import Graph
from tests.runtime.cast import Child, Everything, Parent, message


async def test_a_set_that_a_timer_cannot_follow_is_refused(graph: Graph) -> None:
    """Who sets a rate to zero gets a reason, not a broken timer."""

    class Ticker(Node):
        rate = Param(10.0)
        ticks = 0

        @timer(hz=rate)
        async def tick(self) -> None:
            self.ticks += 1

    node = Ticker()
    await graph.start(node)
    request = SetParameters.Request(parameters=[message("rate", 0.0, 3)])
    [result] = (await graph.call(SetParameters, "/ticker/set_parameters", request)).results
    await graph.clock.advance(0.5)

    assert not result.successful
    assert result.reason == "parameter 'rate' = 0.0: hz must be a positive number, not 0.0"
    assert (node.rate, node.ticks) == (10.0, 5)


class Follower(Node):
    """Record changes of its parameter."""

    rate = Param(1.0)
    other = Param("x")

    def __init__(self) -> None:
        super().__init__()
        self.told: list[Any] = []

    @rate.check
    def not_too_fast(self, rate: float) -> None:
        if rate > 10.0:
            raise ValueError("the listener is only human")

    @rate.on_change
    def note(self, old: float, new: float) -> None:
        self.told.append(("note", old, new))

    @rate.on_change
    async def note_slowly(self, old: float, new: float) -> None:
        await self.clock.sleep(1.0)
        self.told.append(("slowly", old, new))


async def test_a_check_of_the_class_can_refuse(graph: Graph) -> None:
    """Its ValueError is the reason, for callers inside and outside the node; the old value stays."""
    node = Follower()
    await graph.start(node)
    with pytest.raises(ParameterError, match=r"parameter 'rate' = 11\.0: the listener is only human"):
        node.rate = 11.0
    request = SetParameters.Request(parameters=[message("rate", 12.0, 3)])
    (result,) = (await graph.call(SetParameters, "/follower/set_parameters", request)).results
    assert (result.successful, result.reason) == (False, "parameter 'rate' = 12.0: the listener is only human")
    assert (node.rate, node.told) == (1.0, [])


async def test_a_check_of_values_from_outside(graph: Graph) -> None:
    """They were set before `__init__`, and are checked when the node starts; a default is the class's own affair."""
    await graph.start(graph.make(Follower, "slow", rate=9.0))
    with pytest.raises(ParameterError, match=r"'rate' = 11\.0: the listener is only human \(from graph\.make\)$"):
        await graph.start(graph.make(Follower, rate=11.0))

    class Own(Follower):
        def __init__(self) -> None:
            super().__init__()
            self.is_full = False
            self.rate = 5.0
            self.is_full = True

        def not_too_fast(self, rate: float) -> None:
            if self.is_full:
                raise ValueError("no more")

    await graph.start(Own())  # it was checked when it was set

    class Fast(Follower):
        rate = Param(20.0)

        @rate.check
        def not_too_fast(self, rate: float) -> None:
            raise ValueError("never")

    await graph.start(Fast())


def test_a_check_that_returns_something() -> None:
    """It is no answer, and the value is not set: a False would pass unseen."""

    class Sceptic(Node):
        rate = Param(1.0)

        @rate.check
        def never(self, rate: float) -> bool:
            return rate > 5.0

    node = Sceptic()
    with pytest.raises(ParameterError, match=r"'rate' is not set: never returned False; a check refuses by raising"):
        node.rate = 2.0
    assert node.rate == 1.0
    node.rate = 6.0  # as in `return self.fits(rate)`: it can mean nothing else
    assert node.rate == 6.0


async def test_methods_follow_a_parameter(graph: Graph) -> None:
    """`def` at once, `async def` one change after the other; other parameters are none of their business."""
    node = Follower()
    node.rate = 2.0  # before it runs, nobody is told
    await graph.start(node)
    node.rate = 3.0
    node.other = "y"
    assert node.told == [("note", 2.0, 3.0)]
    node.rate = 4.0
    await graph.clock.advance(1.0)
    assert node.told[2:] == [("slowly", 2.0, 3.0)]
    await graph.clock.advance(1.0)
    assert node.told[3:] == [("slowly", 3.0, 4.0)]


async def test_a_follower_that_fails_is_logged(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The change stands, and the node goes on."""

    class Wrong(Node):
        rate = Param(1.0)

        @rate.on_change
        def fail(self, old: float, new: float) -> None:
            raise RuntimeError("cannot")

    node = Wrong()
    await graph.start(node)
    node.rate = 2.0
    assert node.rate == 2.0
    assert "fail: RuntimeError: cannot" in caplog.text
    assert node.is_running


def test_hooks_are_inherited_and_replaced() -> None:
    """A child's method of the name stands in place of its parent's, and does not touch the parent."""

    class Child(Follower):
        def not_too_fast(self, rate: float) -> None:
            if rate > 20.0:
                raise ValueError("too fast even for the child")

    child = Child()
    child.rate = 15.0
    with pytest.raises(ParameterError, match="even for the child"):
        child.rate = 25.0
    with pytest.raises(ParameterError, match="only human"):
        Follower().rate = 15.0


async def test_every_node_has_rclpys_two(graph: Graph) -> None:
    """use_sim_time can be set, start_type_description_service is read-only; no class may declare either."""
    node = Node("n")
    assert node.parameters.get("use_sim_time") is False
    with pytest.raises(ParameterError, match="read-only"):
        node.parameters.set({"start_type_description_service": False})
    with pytest.raises(DeclarationError, match="every node has the parameter 'use_sim_time'"):
        type("Bad", (Node,), {"sim": Param(True, name="use_sim_time")})


async def test_an_overridden_default_sets_the_parents_timer(graph: Graph) -> None:
    """The parent's `@timer(hz=rate)` reads the child's parameter."""
    child, parent = Child(), Parent()
    await graph.start(child, parent)

    await graph.clock.advance(1.0)

    assert child.said.count("parent ticks") == 10
    assert parent.said.count("parent ticks") == 1
    child.rate = 20.0
    await graph.clock.advance(1.0)
    assert child.said.count("parent ticks") == 30


async def test_an_overridden_body_keeps_its_declaration(graph: Graph) -> None:
    """The child's undecorated method is called, once, and may call the parent's."""
    child = Child()
    await graph.start(child)
    graph.publisher(String, "/in").publish(String(data="x"))
    await graph.settle()

    assert child.said == ["parent hears x", "child hears x"]


async def test_a_redeclared_handler_replaces_the_parents(graph: Graph) -> None:
    """A method with another decorator uses the subclass's declaration instead of the parent's."""

    class Redeclared(Parent):
        @subscription(String, "elsewhere")
        async def heard(self, message: String) -> None:
            self.said.append(f"elsewhere {message.data}")

    node = Redeclared()
    await graph.start(node)
    graph.publisher(String, "/in").publish(String(data="old"))
    graph.publisher(String, "/elsewhere").publish(String(data="new"))
    await graph.settle()

    assert node.said == ["elsewhere new"]
    assert [e.name for e in Redeclared.interface().endpoints] == ["out", "elsewhere"]
    assert [e.name for e in Parent.interface().endpoints] == ["out", "in"]


async def test_a_mixin_need_not_be_a_node(graph: Graph) -> None:
    """Declarations of a plain class are found too."""

    class Ticking:
        ticks = 0

        @timer(0.5)
        async def tick(self) -> None:
            self.ticks += 1

    class Mixed(Ticking, Node):
        pass

    node = Mixed()
    await graph.start(node)
    await graph.clock.advance(1.0)

    assert node.ticks == 2


async def test_nodes_of_a_class_share_nothing(graph: Graph) -> None:
    """Each has its own endpoints and values."""
    one, two = Everything("one"), Everything("two")
    one.rate = 5.0

    assert two.rate == 2.0
    assert one.out is not two.out
    assert one.frozen is not two.frozen


async def test_followers_that_set_what_they_follow(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Chains of changes end with an error, at once or later; a single change by a hook is legal."""

    class Circle(Node):
        rate = Param(1.0)
        slow = Param(1.0)
        left = Param(1)
        right = Param(1)

        @rate.on_change
        def changed(self, old: float, new: float) -> None:
            self.rate = new + 1.0

        @slow.on_change
        async def later(self, old: float, new: float) -> None:
            if new > 2.0:
                self.slow = 2.0

        @left.on_change
        async def to_the_right(self, old: int, new: int) -> None:
            self.right = new

        @right.on_change
        async def to_the_left(self, old: int, new: int) -> None:
            self.left = new

    node = Circle()
    await graph.start(node)
    node.slow = 5.0
    await graph.settle()
    assert (node.slow, caplog.messages) == (2.0, [])
    node.rate = 2.0
    await graph.settle()
    assert node.rate == 2.0 + binding.CHAIN
    node.left = 2
    await graph.settle()
    told = [message.partition(", ")[0] for message in caplog.messages]
    assert told == ["changed follows 'rate'", "to_the_right follows 'left'"]


async def test_a_follower_may_change_its_parameter_as_time_goes_by(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """A slow hook, or one triggered by a timer that a hook has started, is legal."""

    class Slow(Node):
        rate = Param(20.0)
        level = Param(0)

        @timer(hz=rate)
        async def tick(self) -> None:
            self.level += 1

        @level.on_change
        async def rise(self, old: int, new: int) -> None:
            self.rate = 20.0
            await self.clock.sleep(0.04)

    node = Slow()
    await graph.start(node)
    await graph.clock.advance(10.0)
    assert node.level > 150
    assert caplog.messages == []
