"""The turtle simulator."""

import asyncio
import logging
import math
from typing import Any
from xml.etree import ElementTree

import pytest

from graphflow import GoalStatus, ParameterError, RemoteError
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.rcl_interfaces.msg import Parameter, ParameterValue
from graphflow.msgs.rcl_interfaces.srv import SetParameters
from graphflow.msgs.std_srvs.srv import Empty, Trigger
from graphflow.msgs.turtlesim.action import RotateAbsolute
from graphflow.msgs.turtlesim.msg import Color, Pose
from graphflow.msgs.turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.testing import Graph
from nodes.turtle_world import SIZE
from nodes.turtlesim import TurtleSim
from tests.cases import slow

TICK = 0.016
BLUE, PEN = Color(r=69, g=86, b=255), Color(r=179, g=184, b=255)


def twist(forward: float = 0.0, turning: float = 0.0, *, sideways: float = 0.0) -> Twist:
    """A velocity command."""
    return Twist(linear=Vector3(x=forward, y=sideways), angular=Vector3(z=turning))


async def picture(graph: Graph, name: str = "/turtlesim") -> ElementTree.Element:
    """Return the simulator's picture."""
    answer = await graph.call(Trigger, f"{name}/snapshot", Trigger.Request())
    assert answer.success
    return ElementTree.fromstring(answer.message)


def find(root: ElementTree.Element, tag: str) -> list[ElementTree.Element]:
    """All elements of a picture with that tag."""
    return list(root.iter(f"{{http://www.w3.org/2000/svg}}{tag}"))


def of_turtles(sim: TurtleSim) -> set[str]:
    """Every topic and service of turtles that is on the network, by full name."""
    names = {e.name for e in sim.context.cache if e.node_name == sim.full_name}
    return {name for name in names if name.count("/") == 2 and not name.startswith("/turtlesim/")}


# the node


def test_it_is_called_turtlesim_and_says_what_it_makes_at_run_time() -> None:
    """Checks of graph files know its name, its parameters and the form of its turtles' names."""
    interface = TurtleSim.interface()

    assert interface.node_name == TurtleSim().name == "turtlesim"
    assert {p.name: p.default for p in interface.params} == {
        "background_r": 69,
        "background_g": 86,
        "background_b": 255,
        "view": False,
        "view_port": 0,
        "holonomic": False,
    }
    assert {(e.name, e.type) for e in interface.endpoints} == {
        ("spawn", "turtlesim/srv/Spawn"),
        ("kill", "turtlesim/srv/Kill"),
        ("clear", "std_srvs/srv/Empty"),
        ("reset", "std_srvs/srv/Empty"),
        ("~/snapshot", "std_srvs/srv/Trigger"),
    }
    assert interface.dynamic_names == (
        "*/turtle1/cmd_vel",
        "*/turtle1/pose",
        "*/?*/cmd_vel",
        "*/?*/pose",
        "*/?*/color_sensor",
        "*/?*/set_pen",
        "*/?*/teleport_absolute",
        "*/?*/teleport_relative",
        "*/?*/rotate_absolute",
    )


async def test_it_starts_with_one_turtle_in_the_middle(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """With turtlesim's log message."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim())
    poses, colors = graph.tap(Pose, "/turtle1/pose"), graph.tap(Color, "/turtle1/color_sensor")

    await graph.clock.advance(TICK)

    assert caplog.messages[:2] == [
        "Starting turtlesim with node name /turtlesim",
        "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
    ]
    assert poses.latest == Pose(x=poses.latest.x, y=poses.latest.x)
    assert poses.latest.x == pytest.approx(5.544445, abs=1e-6)
    assert list(colors) == [BLUE]


async def test_poses_come_at_62_5_hertz(graph: Graph) -> None:
    """One every 16 ms, for every turtle."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")

    await graph.clock.advance(2.0)

    assert len(poses) == 125


async def test_names_follow_the_namespace_and_remaps(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Two simulators live side by side, as in turtlesim's multisim; a rule for a turtle's name is not called unused."""
    await graph.start(
        TurtleSim(namespace="/turtlesim1"),
        TurtleSim(namespace="/turtlesim2", remap=["turtle1/pose:=/where"]),
    )
    first, second = graph.tap(Pose, "/turtlesim1/turtle1/pose"), graph.tap(Pose, "/where")
    await graph.call(Spawn, "/turtlesim2/spawn", Spawn.Request(name="leo"))
    third = graph.tap(Pose, "/turtlesim2/leo/pose")

    await graph.clock.advance(TICK)

    assert [len(first), len(second), len(third)] == [1, 1, 1]
    assert not any("matches no name" in m for m in caplog.messages)


# motion


async def test_a_command_ends_after_a_second(graph: Graph) -> None:
    """At 2 m/s it lasts for 62 ticks; then the turtle stops, as its pose shows."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")
    graph.publisher(Twist, "/turtle1/cmd_vel").publish(twist(2.0, 0.0))

    await graph.clock.advance(0.5)
    assert (poses.latest.linear_velocity, poses.latest.angular_velocity) == (2.0, 0.0)
    await graph.clock.advance(1.0)

    assert poses.latest.x - poses[0].x == pytest.approx(61 * 2.0 * TICK, abs=1e-5)
    assert poses.latest.linear_velocity == 0.0


async def test_a_repeated_command_does_not_end(graph: Graph) -> None:
    """Each command restarts the second."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")
    publisher = graph.publisher(Twist, "/turtle1/cmd_vel")

    for _ in range(5):
        publisher.publish(twist(0.1, 1.0))
        await graph.clock.advance(0.9)

    assert all(p.linear_velocity == pytest.approx(0.1) for p in poses)


async def test_sideways_only_when_holonomic(graph: Graph) -> None:
    """linear.y counts once the parameter is set."""
    sim = TurtleSim()
    await graph.start(sim)
    poses = graph.tap(Pose, "/turtle1/pose")
    publisher = graph.publisher(Twist, "/turtle1/cmd_vel")

    publisher.publish(twist(sideways=1.0))
    await graph.clock.advance(0.16)
    assert poses.latest.y == poses[0].y
    sim.holonomic = True
    publisher.publish(twist(sideways=1.0))
    await graph.clock.advance(0.16)

    assert poses.latest.y - poses[0].y == pytest.approx(0.16, abs=1e-5)


async def test_walls_hold_and_are_complained_of(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Once for each tick that pushes against one, with the place that was not reached."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")
    await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", TeleportAbsolute.Request(x=11.0, y=5.0))
    graph.publisher(Twist, "/turtle1/cmd_vel").publish(twist(1.0, 0.0))

    await graph.clock.advance(0.16)

    assert poses.latest.x == pytest.approx(SIZE, abs=1e-6)
    warnings = [r for r in caplog.records if r.levelno == logging.WARNING]
    assert len(warnings) == 5
    assert warnings[0].getMessage() == "Oh no! I hit the wall! (Clamping from [x=11.096000, y=5.000000])"
    assert warnings[1].getMessage() == "Oh no! I hit the wall! (Clamping from [x=11.104889, y=5.000000])"


async def test_a_command_that_is_no_number_changes_nothing(graph: Graph) -> None:
    """The turtle continues with the previous command."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")
    publisher = graph.publisher(Twist, "/turtle1/cmd_vel")
    publisher.publish(twist(1.0))
    publisher.publish(twist(math.nan))

    await graph.clock.advance(0.16)

    assert poses.latest.linear_velocity == 1.0


async def test_teleports_go_there_at_once(graph: Graph) -> None:
    """Absolute is absolute; relative turns, then moves ahead."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")

    request = TeleportAbsolute.Request(x=2.0, y=3.0, theta=math.pi / 2)
    await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", request)
    await graph.clock.advance(TICK)
    assert poses.latest == Pose(x=2.0, y=3.0, theta=poses.latest.theta)
    assert poses.latest.theta == pytest.approx(math.pi / 2)
    relative = TeleportRelative.Request(linear=1.0, angular=math.pi / 2)
    await graph.call(TeleportRelative, "/turtle1/teleport_relative", relative)
    await graph.clock.advance(TICK)

    assert (poses.latest.x, poses.latest.y) == pytest.approx((1.0, 3.0))
    assert abs(poses.latest.theta) == pytest.approx(math.pi)


async def test_a_teleport_to_nowhere_is_the_callers_error(graph: Graph) -> None:
    """The client gets the reason, and the turtle stays."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")
    with pytest.raises(RemoteError, match="out of a turtle's range"):
        await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", TeleportAbsolute.Request(x=math.nan))

    await graph.clock.advance(TICK)

    assert poses.latest.x == pytest.approx(SIZE / 2, abs=1e-6)


# turtles come and go


async def test_spawn_gives_names_and_endpoints(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The given name, or the next turtleN; six names on the network for each."""
    caplog.set_level(logging.INFO)
    sim = TurtleSim()
    await graph.start(sim)

    named = await graph.call(Spawn, "/spawn", Spawn.Request(x=2.0, y=3.0, theta=0.5, name="turtle2"))
    unnamed = await graph.call(Spawn, "/spawn", Spawn.Request(x=1.0, y=1.0))

    assert (named.name, unnamed.name) == ("turtle2", "turtle3")
    assert "Spawning turtle [turtle2] at x=[2.000000], y=[3.000000], theta=[0.500000]" in caplog.messages
    parts = {"cmd_vel", "pose", "color_sensor", "set_pen", "teleport_absolute", "teleport_relative"}
    assert of_turtles(sim) == {f"/turtle{n}/{part}" for n in (1, 2, 3) for part in parts}
    poses = graph.tap(Pose, "/turtle2/pose")
    await graph.clock.advance(TICK)
    assert list(poses) == [Pose(x=2.0, y=3.0, theta=0.5)]


async def test_a_taken_name_is_an_error_and_an_empty_reply(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The turtle that has it is not moved."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")

    reply = await graph.call(Spawn, "/spawn", Spawn.Request(x=1.0, y=1.0, name="turtle1"))
    await graph.clock.advance(TICK)

    assert reply.name == ""
    assert ("A turtle named [turtle1] already exists", logging.ERROR) in [
        (r.getMessage(), r.levelno) for r in caplog.records
    ]
    assert poses.latest.x == pytest.approx(5.544445, abs=1e-6)


@pytest.mark.parametrize("name", ["my turtle", "2fast", "turtle-2", "x" * 240])
async def test_a_name_no_topic_can_have_is_refused(graph: Graph, caplog: pytest.LogCaptureFixture, name: str) -> None:
    """The log has an error, the response is empty, and network and picture are unchanged."""
    sim = TurtleSim()
    await graph.start(sim)
    before = of_turtles(sim)
    assert len(before) == 6

    reply = await graph.call(Spawn, "/spawn", Spawn.Request(name=name))

    assert reply.name == ""
    assert any(m.startswith(f"A turtle cannot be named [{name}]") for m in caplog.messages)
    assert of_turtles(sim) == before
    assert len(find(await picture(graph), "title")) == 1


async def test_kill_takes_a_turtle_and_its_endpoints_away(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Killing it again is an error that turtlesim has words for."""
    sim = TurtleSim()
    await graph.start(sim)
    await graph.call(Spawn, "/spawn", Spawn.Request(name="turtle2"))
    poses = graph.tap(Pose, "/turtle1/pose")

    await graph.call(Kill, "/kill", Kill.Request(name="turtle1"))
    await graph.clock.advance(0.16)

    assert not poses
    assert {name.split("/")[1] for name in of_turtles(sim)} == {"turtle2"}
    assert [t.text for t in find(await picture(graph), "title")] == ["turtle2"]
    await graph.call(Kill, "/kill", Kill.Request(name="turtle1"))
    assert "Tried to kill turtle [turtle1], which does not exist" in caplog.messages


async def test_reset_begins_again(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """One turtle in the middle, an empty canvas, numbers from one, and the new turtle obeys."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim())
    await graph.call(Spawn, "/spawn", Spawn.Request(x=1.0, y=1.0))
    await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", TeleportAbsolute.Request(x=1.0))

    await graph.call(Empty, "/reset", Empty.Request())

    drawn = await picture(graph)
    assert ([t.text for t in find(drawn, "title")], find(drawn, "polyline")) == (["turtle1"], [])
    assert caplog.messages[-2:] == [
        "Resetting turtlesim.",
        "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
    ]
    assert (await graph.call(Spawn, "/spawn", Spawn.Request())).name == "turtle2"
    poses = graph.tap(Pose, "/turtle1/pose")
    graph.publisher(Twist, "/turtle1/cmd_vel").publish(twist(1.0, 0.0))
    await graph.clock.advance(0.16)
    assert poses.latest.x == pytest.approx(SIZE / 2 + 0.16, abs=1e-5)


# rotate_absolute


async def rotation(graph: Graph, theta: float) -> ClientGoalHandle[Any, Any, Any]:
    client = graph.action_client(RotateAbsolute, "/turtle1/rotate_absolute")
    await graph.settle()
    return await client.send_goal(RotateAbsolute.Goal(theta=theta))


async def test_a_turtle_turns_to_an_absolute_angle(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """At 1 rad/s, with feedback every tick; the result has turtlesim's sign, and ends within its tolerance."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose", 1000)
    goal = await rotation(graph, 1.57)
    heard: list[float] = []

    async def listen() -> None:
        async for feedback in goal.feedback():
            heard.append(feedback.remaining)

    listening = asyncio.ensure_future(listen())
    await graph.clock.advance(2.0)
    await listening

    assert (await goal.result()).delta == pytest.approx(-1.552, abs=1e-3)
    assert len(heard) == 98
    assert heard[0] == pytest.approx(1.57)
    assert heard[-1] == pytest.approx(0.018, abs=1e-3)
    assert {round(p.angular_velocity, 6) for p in poses} == {0.0, 1.0}
    assert poses.latest.angular_velocity == 0.0
    assert caplog.messages[-1] == "Rotation goal completed successfully"


async def test_the_short_way_round(graph: Graph) -> None:
    """Past pi it turns to the right."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose", 1000)
    goal = await rotation(graph, 4.0)
    await graph.clock.advance(3.0)

    assert goal.status is GoalStatus.SUCCEEDED
    assert min(p.angular_velocity for p in poses) == -1.0
    assert poses.latest.theta == pytest.approx(4.0 - math.tau, abs=0.02)


async def test_a_rotation_is_cancelled(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The turtle stops where it is."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose", 1000)
    goal = await rotation(graph, 3.0)
    await graph.clock.advance(1.0)
    assert await goal.cancel()
    await graph.clock.advance(1.0)

    assert goal.status is GoalStatus.CANCELED
    assert poses.latest.theta == pytest.approx(1.0, abs=0.05)
    assert caplog.messages[-1] == "Rotation goal canceled"


async def test_a_newer_rotation_aborts_the_older(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """With a log message, as in turtlesim."""
    await graph.start(TurtleSim())
    older = await rotation(graph, 3.0)
    await graph.clock.advance(0.5)
    newer = await rotation(graph, 0.0)
    await graph.clock.advance(1.0)

    assert (older.status, newer.status) == (GoalStatus.ABORTED, GoalStatus.SUCCEEDED)
    assert [r.message for r in caplog.records if r.levelno == logging.WARNING] == [
        "Rotation goal received before a previous goal finished. Aborting previous goal"
    ]


async def test_a_velocity_command_aborts_a_rotation(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """With a log message, as in turtlesim; the turtle obeys the command."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose", 1000)
    goal = await rotation(graph, 3.0)
    await graph.clock.advance(0.5)
    graph.publisher(Twist, "/turtle1/cmd_vel").publish(twist(1.0))
    await graph.clock.advance(0.5)

    assert goal.status is GoalStatus.ABORTED
    assert [r.message for r in caplog.records if r.levelno == logging.WARNING] == [
        "Velocity command received during rotation goal. Aborting goal"
    ]
    assert (poses.latest.linear_velocity, poses.latest.angular_velocity) == (1.0, 0.0)


async def test_a_turtle_that_is_killed_while_it_turns(graph: Graph) -> None:
    """Its goal ends with it."""
    await graph.start(TurtleSim())
    goal = await rotation(graph, 3.0)
    await graph.clock.advance(0.5)
    await graph.call(Kill, "/kill", Kill.Request(name="turtle1"))
    await graph.clock.advance(2.0)

    assert goal.done


# the drawing


async def test_set_pen_changes_what_is_drawn_from_then_on(graph: Graph) -> None:
    """Colour and width; width 0 counts as 1; off draws nothing; switching on again needs a colour."""
    await graph.start(TurtleSim())

    async def go(x: float) -> None:
        request = TeleportAbsolute.Request(x=x, y=5.0)
        await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", request)

    await go(1.0)
    await graph.call(SetPen, "/turtle1/set_pen", SetPen.Request(r=255, width=5))
    await go(2.0)
    await graph.call(SetPen, "/turtle1/set_pen", SetPen.Request(r=9, off=1))
    await go(3.0)
    await graph.call(SetPen, "/turtle1/set_pen", SetPen.Request(g=255))
    await go(4.0)

    lines = find(await picture(graph), "polyline")
    assert [(line.get("stroke"), line.get("stroke-width")) for line in lines] == [
        ("#b3b8ff", "3"),
        ("#ff0000", "5"),
        ("#00ff00", "1"),
    ]


async def test_clear_wipes_the_drawing_and_leaves_the_turtles(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Later lines are drawn."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim())
    await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", TeleportAbsolute.Request(x=1.0, y=1.0))

    await graph.call(Empty, "/clear", Empty.Request())
    assert find(await picture(graph), "polyline") == []
    await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", TeleportAbsolute.Request(x=2.0, y=1.0))

    drawn = await picture(graph)
    assert [line.get("points") for line in find(drawn, "polyline")] == ["45.5,454.5 90.5,454.5"]
    assert [t.text for t in find(drawn, "title")] == ["turtle1"]
    assert "Clearing turtlesim." in caplog.messages


async def test_the_colour_sensor_sees_what_is_drawn(graph: Graph) -> None:
    """The line under a turtle, else the background as it is now."""
    sim = TurtleSim()
    await graph.start(sim)
    colors = graph.tap(Color, "/turtle1/color_sensor")
    await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", TeleportAbsolute.Request(x=1.0, y=1.0))
    await graph.clock.advance(TICK)
    assert colors.latest == PEN

    await graph.call(Empty, "/clear", Empty.Request())
    sim.background_g = 0
    await graph.clock.advance(TICK)

    assert colors.latest == Color(r=69, g=0, b=255)


async def test_a_background_set_from_outside_is_seen_at_once(graph: Graph) -> None:
    """No clear is needed."""
    await graph.start(TurtleSim())
    value = ParameterValue(type=2, integer_value=200)

    reply = await graph.call(
        SetParameters,
        "/turtlesim/set_parameters",
        SetParameters.Request(parameters=[Parameter(name="background_r", value=value)]),
    )

    assert [r.successful for r in reply.results] == [True]
    assert find(await picture(graph), "rect")[0].get("fill") == "#c856ff"


@slow
async def test_a_colour_of_300_is_refused(graph: Graph) -> None:
    """By the service with a reason, by the constructor with an error; the old colour stays."""
    sim = TurtleSim()
    await graph.start(sim)
    value = ParameterValue(type=2, integer_value=300)

    reply = await graph.call(
        SetParameters,
        "/turtlesim/set_parameters",
        SetParameters.Request(parameters=[Parameter(name="background_r", value=value)]),
    )

    assert not reply.results[0].successful
    assert "0 to 255" in reply.results[0].reason
    assert sim.background == (69, 86, 255)
    with pytest.raises(ParameterError, match="0 to 255"):
        TurtleSim(background_b=300)


# angles


@slow
@pytest.mark.parametrize("way", ["spawn", "absolute", "relative", "goal"])
async def test_an_angle_in_degrees(graph: Graph, caplog: pytest.LogCaptureFixture, way: str) -> None:
    """Is explained once, however it is given, and obeyed as radians."""
    await graph.start(TurtleSim())
    poses = graph.tap(Pose, "/turtle1/pose")
    for _ in range(2):
        match way:
            case "spawn":
                await graph.call(Spawn, "/spawn", Spawn.Request(theta=90.0))
            case "absolute":
                there = TeleportAbsolute.Request(x=2.0, theta=90.0)
                await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", there)
            case "relative":
                turn = TeleportRelative.Request(angular=90.0)
                await graph.call(TeleportRelative, "/turtle1/teleport_relative", turn)
            case "goal":
                await rotation(graph, 90.0)
        await graph.clock.advance(6.0)
    field = "angular" if way == "relative" else "theta"
    assert [r.message for r in caplog.records if r.levelno == logging.WARNING] == [
        f"{field} is in radians; 90 degrees are 1.571"
    ]
    if way == "absolute":
        assert poses.latest.theta == pytest.approx(90.0 - 14 * math.tau, abs=1e-4)


async def test_angles_that_go_on_growing(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Are radians, as any below 2 pi are, and any that is no round number of degrees."""
    await graph.start(TurtleSim())
    for theta in (5.0, -6.0, 6.28, 7.1, *(0.5 * n for n in range(13, 40))):
        request = TeleportAbsolute.Request(theta=theta)
        await graph.call(TeleportAbsolute, "/turtle1/teleport_absolute", request)
    await graph.call(TeleportRelative, "/turtle1/teleport_relative", TeleportRelative.Request(angular=2 * math.tau))
    assert [r.message for r in caplog.records if r.levelno == logging.WARNING] == []
