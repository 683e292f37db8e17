"""The services of a simulator in the words of ROS's simulation_interfaces, below its node's name, as Gazebo has them.

    graphflow service call /simulator/spawn_entity simulation_interfaces/srv/SpawnEntity "{name: second, uri: waffle}"
    graphflow service call /simulator/step_simulation simulation_interfaces/srv/StepSimulation "{steps: 200}"

The entities are the robots. A robot without a name is called like its model.
"""

from __future__ import annotations

import asyncio
import math
from pathlib import Path

from graphflow import GraphFileError, InvalidName, Node, Param, service
from graphflow.msgs.geometry_msgs.msg import Point, Pose, Quaternion
from graphflow.msgs.simulation_interfaces.msg import Result, SimulationState, SimulatorFeatures
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
from graphflow.msgs.std_msgs.msg import Header
from graphflow.simulator import SimulatedRobot, Simulation, robot_model, spawned

from .robot_topics import RobotTopics

STEPS_BOUND = 100_000
"""Steps of one call, at most: more than eight minutes of simulated time."""
AT_ONCE = 50
"""Steps between two moments in which the node does other things."""
FEATURES = [
    SimulatorFeatures.SPAWNING,
    SimulatorFeatures.DELETING,
    SimulatorFeatures.ENTITY_STATE_GETTING,
    SimulatorFeatures.ENTITY_STATE_SETTING,
    SimulatorFeatures.SIMULATION_RESET,
    SimulatorFeatures.SIMULATION_RESET_TIME,
    SimulatorFeatures.SIMULATION_RESET_STATE,
    SimulatorFeatures.SIMULATION_STATE_GETTING,
    SimulatorFeatures.SIMULATION_STATE_SETTING,
    SimulatorFeatures.SIMULATION_STATE_PAUSE,
    SimulatorFeatures.STEP_SIMULATION_SINGLE,
    SimulatorFeatures.STEP_SIMULATION_MULTIPLE,
]
FLAT = 0.1
"""Height in metres, and x and y of a rotation, that count as those of a robot that stands."""
OK = Result(result=Result.RESULT_OK)


def failed(result: int, text: str) -> Result:
    """Return a result that is not OK."""
    return Result(result=result, error_message=text)


class SimulationServices(Node):
    """The services; a subclass has the simulation."""

    paused = Param(False, doc="Whether simulated time stands still.")
    simulation: Simulation
    robots: dict[str, RobotTopics]

    def announce(self, name: str) -> None:
        """Create the topics of a robot."""
        raise NotImplementedError

    def step(self) -> None:
        """Let one tick pass, and publish what is due then."""
        raise NotImplementedError

    def restart(self) -> None:
        """Begin again at time 0."""
        raise NotImplementedError

    def entity(self, name: str) -> SimulatedRobot | None:
        """Return a robot by its name, or one without a name by that of its model."""
        found = self.simulation.robots.get(name.strip("/"))
        unnamed = self.simulation.robots.get("")
        return unnamed if found is None and unnamed is not None and name in ("", unnamed.robot.name) else found

    def missing(self, name: str) -> Result:
        """Return the result for a robot that does not exist."""
        known = ", ".join(self.names()) or "none"
        return failed(Result.RESULT_NOT_FOUND, f"there is no robot {name!r}; there is {known}")

    def names(self) -> list[str]:
        """Return the names of all robots."""
        return [name or robot.robot.name for name, robot in self.simulation.robots.items()]

    @service(SpawnEntity, "~/spawn_entity")
    async def spawn_entity(self, request: SpawnEntity.Request) -> SpawnEntity.Response:
        """Add a robot: `uri` is a model such as burger, or a robot file."""
        place = planar(request.initial_pose.pose)
        if isinstance(place, str):
            return SpawnEntity.Response(result=failed(SpawnEntity.Response.INVALID_POSE, place))
        name = request.name or (Path(request.uri).stem if request.allow_renaming else "")
        taken = bool(name) and name in self.simulation.robots
        if taken and request.allow_renaming:
            name = next(f"{name}{i}" for i in range(2, 1000) if f"{name}{i}" not in self.simulation.robots)
        elif taken or not name:
            kind = SpawnEntity.Response.NAME_NOT_UNIQUE if taken else SpawnEntity.Response.NAME_INVALID
            text = f"there is a robot {name!r} already" if taken else "give the robot a name, or allow_renaming"
            return SpawnEntity.Response(result=failed(kind, text))
        try:
            model = robot_model(request.uri or "burger")
            self.simulation.spawn(spawned(name, *place), model)
        except GraphFileError as error:
            return SpawnEntity.Response(result=failed(SpawnEntity.Response.RESOURCE_PARSE_ERROR, str(error)))
        except FileNotFoundError as error:
            return SpawnEntity.Response(result=failed(SpawnEntity.Response.NO_RESOURCE, str(error)))
        except InvalidName as error:
            return SpawnEntity.Response(result=failed(SpawnEntity.Response.NAME_INVALID, str(error)))
        except ValueError as error:
            return SpawnEntity.Response(result=failed(SpawnEntity.Response.INVALID_POSE, str(error)))
        self.announce(name)
        return SpawnEntity.Response(result=OK, entity_name=name)

    @service(DeleteEntity, "~/delete_entity")
    async def delete(self, request: DeleteEntity.Request) -> DeleteEntity.Response:
        """Take a robot out of the world."""
        robot = self.entity(request.entity)
        if robot is None:
            return DeleteEntity.Response(result=self.missing(request.entity))
        self.simulation.delete(robot.placed.name)
        self.robots.pop(robot.placed.name).close()
        return DeleteEntity.Response(result=OK)

    @service(GetEntities, "~/get_entities")
    async def list_entities(self, request: GetEntities.Request) -> GetEntities.Response:
        return GetEntities.Response(result=OK, entities=self.names())

    @service(GetEntityState, "~/get_entity_state")
    async def get_state(self, request: GetEntityState.Request) -> GetEntityState.Response:
        """Return the true place of a robot in the world."""
        robot = self.entity(request.entity)
        if robot is None:
            return GetEntityState.Response(result=self.missing(request.entity))
        response, pose = GetEntityState.Response(result=OK), robot.pose
        turn = Quaternion(z=math.sin(pose.yaw / 2), w=math.cos(pose.yaw / 2))
        response.state.header = Header(frame_id="world", stamp=self.clock.now())
        response.state.pose = Pose(position=Point(x=pose.x, y=pose.y), orientation=turn)
        return response

    @service(SetEntityState, "~/set_entity_state")
    async def teleport(self, request: SetEntityState.Request) -> SetEntityState.Response:
        """Put a robot at a place, at rest; its odometry does not know."""
        robot, place = self.entity(request.entity), planar(request.state.pose)
        if robot is None:
            return SetEntityState.Response(result=self.missing(request.entity))
        if isinstance(place, str):
            return SetEntityState.Response(result=failed(SetEntityState.Response.INVALID_POSE, place))
        try:
            self.simulation.teleport(robot.placed.name, *place)
        except ValueError as error:
            return SetEntityState.Response(result=failed(SetEntityState.Response.INVALID_POSE, str(error)))
        return SetEntityState.Response(result=OK)

    @service(ResetSimulation, "~/reset_simulation")
    async def reset_all(self, request: ResetSimulation.Request) -> ResetSimulation.Response:
        """Begin again; spawned robots stay, at their first places."""
        self.restart()
        return ResetSimulation.Response(result=OK)

    @service(GetSimulationState, "~/get_simulation_state")
    async def simulation_state(self, request: GetSimulationState.Request) -> GetSimulationState.Response:
        state = SimulationState.STATE_PAUSED if self.paused else SimulationState.STATE_PLAYING
        return GetSimulationState.Response(result=OK, state=SimulationState(state=state))

    @service(SetSimulationState, "~/set_simulation_state")
    async def set_simulation_state(self, request: SetSimulationState.Request) -> SetSimulationState.Response:
        """Pause (2), go on (1), or stop (0): reset and pause."""
        wanted = request.state.state
        if wanted not in (SimulationState.STATE_STOPPED, SimulationState.STATE_PLAYING, SimulationState.STATE_PAUSED):
            text = f"the state {wanted} is none of 0 (stopped), 1 (playing) and 2 (paused)"
            return SetSimulationState.Response(result=failed(SetSimulationState.Response.INCORRECT_TRANSITION, text))
        if wanted == SimulationState.STATE_STOPPED:
            self.restart()
        self.paused = wanted != SimulationState.STATE_PLAYING
        return SetSimulationState.Response(result=OK)

    @service(StepSimulation, "~/step_simulation")
    async def step_simulation(self, request: StepSimulation.Request) -> StepSimulation.Response:
        """Let some ticks pass while the simulation is paused; returns when they have."""
        if not self.paused:
            text = "the simulation is not paused: set the parameter paused, or call set_simulation_state with 2"
            return StepSimulation.Response(result=failed(Result.RESULT_INCORRECT_STATE, text))
        if request.steps > STEPS_BOUND:
            text = f"{request.steps:,} steps are more than {STEPS_BOUND:,}, the most of one call"
            return StepSimulation.Response(result=failed(Result.RESULT_OPERATION_FAILED, text))
        for index in range(request.steps):
            self.step()
            if index % AT_ONCE == AT_ONCE - 1:
                await asyncio.sleep(0)
        return StepSimulation.Response(result=OK)

    @service(GetSimulatorFeatures, "~/get_simulator_features")
    async def features(self, request: GetSimulatorFeatures.Request) -> GetSimulatorFeatures.Response:
        features = SimulatorFeatures(features=FEATURES, spawn_formats=["yaml"], custom_info="graphflow, MuJoCo")
        return GetSimulatorFeatures.Response(features=features)


def planar(pose: Pose) -> tuple[float, float, float] | str:
    """Return x, y and yaw of a pose, or the reason why no robot can have it. A rotation of zeros is none."""
    at, turn = pose.position, pose.orientation
    yaw = math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))
    if not math.isfinite(at.x + at.y + at.z + yaw):
        return "the pose has a number that is not finite"
    if max(abs(at.x), abs(at.y)) > Simulation.end:
        return f"({at.x:g}, {at.y:g}) lies beyond the end of the world, {Simulation.end:g} m from its middle"
    if abs(at.z) > FLAT or max(abs(turn.x), abs(turn.y)) > FLAT:
        return "a robot stands upright on the floor: give z: 0, and a rotation about z only"
    return at.x, at.y, yaw
