"""A simulator steered with ROS's simulation_interfaces."""

from __future__ import annotations

import math
from typing import Any

import pytest

from graphflow.msgs.geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.simulation_interfaces.msg import EntityState, Result, SimulationState, SimulatorFeatures
from graphflow.msgs.simulation_interfaces.srv import (
    DeleteEntity,
    GetEntities,
    GetEntityState,
    GetSimulationState,
    GetSimulatorFeatures,
    ResetSimulation,
    SetEntityState,
    SetSimulationState,
    SpawnEntity,
    StepSimulation,
)
from graphflow.testing import Graph
from nodes.robot_simulator import RobotSimulator

NOT_FOUND, OK = Result.RESULT_NOT_FOUND, Result.RESULT_OK


def at(x: float, y: float, yaw: float = 0.0) -> Pose:
    return Pose(position=Point(x=x, y=y), orientation=Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2)))


async def simulator(graph: Graph, **parameters: Any) -> RobotSimulator:
    node = RobotSimulator(world="empty", **parameters)
    await graph.start(node)
    return node


async def test_robots_come_and_go(graph: Graph) -> None:
    """A new one has its topics and sees the first; when it is deleted, its topics are gone."""
    node = await simulator(graph)
    spawn = SpawnEntity.Request(name="second", uri="waffle", initial_pose=PoseStamped(pose=at(1.0, 0.5, 1.57)))
    answer = await graph.call(SpawnEntity, "/simulator/spawn_entity", spawn)
    assert (answer.result.result, answer.entity_name) == (OK, "second")
    scans = graph.tap(LaserScan, "/second/scan")
    await graph.clock.advance(1.0)
    assert len(scans) == pytest.approx(5, abs=1)
    found = await graph.call(GetEntities, "/simulator/get_entities", GetEntities.Request())
    assert list(found.entities) == ["burger", "second"]
    state = await graph.call(GetEntityState, "/simulator/get_entity_state", GetEntityState.Request(entity="second"))
    assert (state.state.pose.position.x, state.state.pose.position.y) == pytest.approx((1.0, 0.5), abs=0.01)
    deleted = await graph.call(DeleteEntity, "/simulator/delete_entity", DeleteEntity.Request(entity="second"))
    assert deleted.result.result == OK
    count = len(scans)
    await graph.clock.advance(1.0)
    assert len(scans) == count
    assert list(node.robots) == [""]


@pytest.mark.parametrize(
    ("request_", "code", "text"),
    [
        ({"name": ""}, SpawnEntity.Response.NAME_INVALID, "give the robot a name, or allow_renaming"),
        ({"name": "a b"}, SpawnEntity.Response.NAME_INVALID, "'a b' is not a node name"),
        ({"name": "x", "uri": "burgr"}, SpawnEntity.Response.NO_RESOURCE, "did you mean 'burger'?"),
        (
            {"name": "x", "initial_pose": PoseStamped(pose=at(math.nan, 0.0))},
            SpawnEntity.Response.INVALID_POSE,
            "the pose has a number that is not finite",
        ),
        ({"name": "x"}, SpawnEntity.Response.INVALID_POSE, "(0, 0) is inside the robot 'burger'"),
    ],
)
async def test_robots_that_are_refused(graph: Graph, request_: dict[str, Any], code: int, text: str) -> None:
    """The result says why, and nothing has changed."""
    node = await simulator(graph)
    answer = await graph.call(SpawnEntity, "/simulator/spawn_entity", SpawnEntity.Request(**request_))
    assert answer.result.result == code
    assert text in answer.result.error_message
    assert list(node.simulation.robots) == [""]


async def test_names_that_are_taken(graph: Graph) -> None:
    """They are refused, or changed where that is allowed."""
    await simulator(graph)
    answers = []
    for x, renaming in ((1.0, False), (2.0, False), (3.0, True)):
        pose = PoseStamped(pose=at(x, 0.0))
        request = SpawnEntity.Request(name="a", allow_renaming=renaming, initial_pose=pose)
        answers.append(await graph.call(SpawnEntity, "/simulator/spawn_entity", request))
    assert [answer.result.result for answer in answers] == [OK, SpawnEntity.Response.NAME_NOT_UNIQUE, OK]
    assert [answer.entity_name for answer in answers] == ["a", "", "a2"]


async def test_teleporting(graph: Graph) -> None:
    """The robot is elsewhere at once, and its odometry does not know."""
    node = await simulator(graph)
    request = SetEntityState.Request(entity="burger", state=EntityState(pose=at(2.0, -1.0, 0.7)))
    answer = await graph.call(SetEntityState, "/simulator/set_entity_state", request)
    assert answer.result.result == OK
    await graph.clock.advance(0.2)
    robot = node.simulation.robots[""]
    assert (robot.pose.x, robot.pose.y, robot.pose.yaw) == pytest.approx((2.0, -1.0, 0.7), abs=0.01)
    assert robot.odometry.x == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize(
    ("pose", "text"),
    [
        (at(math.inf, 0.0), "a number that is not finite"),
        (at(1e30, 0.0), "(1e+30, 0) lies beyond the end of the world, 100 m from its middle"),
        (Pose(position=Point(z=0.3)), "a robot stands upright on the floor: give z: 0, and a rotation about z only"),
        (Pose(orientation=Quaternion(x=1.0, w=0.0)), "a robot stands upright on the floor"),
        (at(1.0, 0.0), "(1, 0) is inside the robot 'second'"),
    ],
)
async def test_places_of_no_robot(graph: Graph, pose: Pose, text: str) -> None:
    """The robot stays where it is."""
    node = await simulator(graph)
    spawn = SpawnEntity.Request(name="second", initial_pose=PoseStamped(pose=at(1.0, 0.0)))
    await graph.call(SpawnEntity, "/simulator/spawn_entity", spawn)
    request = SetEntityState.Request(entity="burger", state=EntityState(pose=pose))
    answer = await graph.call(SetEntityState, "/simulator/set_entity_state", request)
    assert answer.result.result == SetEntityState.Response.INVALID_POSE
    assert text in answer.result.error_message
    assert node.simulation.robots[""].pose.x == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize(
    ("kind", "name", "request_"),
    [
        (DeleteEntity, "delete_entity", DeleteEntity.Request(entity="nobody")),
        (GetEntityState, "get_entity_state", GetEntityState.Request(entity="nobody")),
        (SetEntityState, "set_entity_state", SetEntityState.Request(entity="nobody")),
    ],
)
async def test_robots_that_do_not_exist(graph: Graph, kind: Any, name: str, request_: Any) -> None:
    """The result names those that do."""
    await simulator(graph)
    answer = await graph.call(kind, f"/simulator/{name}", request_)
    assert answer.result.result == NOT_FOUND
    assert answer.result.error_message == "there is no robot 'nobody'; there is burger"


async def test_pausing_and_stepping(graph: Graph) -> None:
    """While it is paused, time passes only by steps; stopping begins again."""
    node = await simulator(graph)
    await graph.clock.advance(1.0)
    refused = await graph.call(StepSimulation, "/simulator/step_simulation", StepSimulation.Request(steps=1))
    assert refused.result.result == Result.RESULT_INCORRECT_STATE
    assert "the simulation is not paused" in refused.result.error_message

    async def become(state: int) -> int:
        request = SetSimulationState.Request(state=SimulationState(state=state))
        return int((await graph.call(SetSimulationState, "/simulator/set_simulation_state", request)).result.result)

    assert await become(SimulationState.STATE_PAUSED) == OK
    before = node.simulation.time
    stepped = await graph.call(StepSimulation, "/simulator/step_simulation", StepSimulation.Request(steps=200))
    assert stepped.result.result == OK
    assert node.simulation.time - before == pytest.approx(200 * node.simulation.tick_seconds)
    too_many = await graph.call(StepSimulation, "/simulator/step_simulation", StepSimulation.Request(steps=10**9))
    assert "1,000,000,000 steps are more than 100,000" in too_many.result.error_message
    state = await graph.call(GetSimulationState, "/simulator/get_simulation_state", GetSimulationState.Request())
    assert state.state.state == SimulationState.STATE_PAUSED
    assert await become(SimulationState.STATE_STOPPED) == OK
    assert (node.simulation.time, node.paused) == (0.0, True)
    assert await become(SimulationState.STATE_PLAYING) == OK
    assert not node.paused
    assert await become(SimulationState.STATE_QUITTING) == SetSimulationState.Response.INCORRECT_TRANSITION
    await graph.clock.advance(0.5)
    reset = await graph.call(ResetSimulation, "/simulator/reset_simulation", ResetSimulation.Request())
    assert reset.result.result == OK
    assert node.simulation.time == 0.0


async def test_features(graph: Graph) -> None:
    """What it can do is listed."""
    await simulator(graph)
    found = await graph.call(GetSimulatorFeatures, "/simulator/get_simulator_features", GetSimulatorFeatures.Request())
    assert SimulatorFeatures.SPAWNING in found.features.features
    assert list(found.features.spawn_formats) == ["yaml"]
