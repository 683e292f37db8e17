"""A simulator of wheeled robots with a laser scanner, such as the TurtleBot3, on the physics engine MuJoCo.

    pip install 'graphflow-zenoh[sim]'
    graphflow up graphs/tb_sim.yaml world:=house

It takes `cmd_vel` and publishes `scan`, `odom`, `imu`, `joint_states`, `battery_state`, `bumper`, images, transforms
and `/clock`. Several robots of a world have their topics and frames below their names. Worlds and robots are YAML
files: see `graphflow/simulator/worlds/` and `robots/`.
"""

from __future__ import annotations

import graphflow
from graphflow import Param, Publisher, Time, service, timer
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.qos import CLOCK
from graphflow.simulator import simulate
from graphflow.tf import Transforms

from .robot_topics import Due, RobotTopics
from .simulation_services import SimulationServices

PERIOD = 0.01
"""Seconds between two turns of the node, in each of which the simulation catches up with the time."""
CLOCK_HZ = 100.0
BEHIND = 0.1
"""Seconds of simulated time that one turn makes up for; what exceeds them is lost, and the simulation slower."""


class RobotSimulator(SimulationServices):
    """A world with robots."""

    node_name = "simulator"
    dynamic_names = True

    world = Param("hexagon", read_only=True, doc="A bundled world, or a world file's path.")
    model = Param("", read_only=True, doc="A robot in place of those of the world: burger, waffle, rover, or a file.")
    seed = Param(0, ge=0, read_only=True, doc="Of all noise; the same seed gives the same run.")
    rate = Param(1.0, gt=0.0, le=100.0, doc="How fast simulated time runs; 2.0 is twice as fast.")
    stamped = Param(False, read_only=True, doc="Whether cmd_vel is announced as TwistStamped; both are taken.")
    clock_topic = Publisher(Clock, "/clock", CLOCK)
    tf = Transforms(listen=False)

    async def on_start(self) -> None:
        self.simulation = simulate(self.world, self.seed, self.model)
        self.robots = {}
        for name in self.simulation.robots:
            self.announce(name)
        self.log.info("world %s: %s", self.world, ", ".join(t.title for t in self.robots.values()) or "no robot")
        if not self.robots:
            text = "the world has no robot: add `robots: [{model: burger}]`, or call spawn_entity"
            self.log.warning("%s", text)
        self.clock_due = Due(CLOCK_HZ)
        self.owed, self.before = 0.0, self.context.clock.monotonic_ns()
        self.in_trouble: set[str] = set()

    def announce(self, name: str) -> None:
        """Create the topics of a robot."""
        self.robots[name] = topics = RobotTopics(self, self.tf, self.simulation.robots[name], stamped=self.stamped)
        topics.send_fixed_frames()

    @timer(PERIOD)
    async def turn(self) -> None:
        now = self.context.clock.monotonic_ns()
        passed, self.before = (now - self.before) / 1e9, now
        if self.paused:
            return
        self.owed += min(passed, BEHIND) * self.rate
        while self.owed >= self.simulation.tick_seconds:
            self.owed -= self.simulation.tick_seconds
            self.step()

    def step(self) -> None:
        """Let one tick pass, and publish what is due then."""
        self.simulation.tick()
        time = self.simulation.time
        if self.clock_due.is_now(time):
            self.clock_topic.publish(Clock(clock=Time(round(time * 1e9))))
        for name, topics in self.robots.items():
            topics.publish(time)
            trouble = topics.robot.trouble
            if trouble and name not in self.in_trouble:
                self.in_trouble.add(name)
                self.log.error("robot %s: %s; call reset_simulation", name or topics.robot.robot.name, trouble)

    def restart(self) -> None:
        """Begin again: time is 0, and everything is where it was."""
        self.simulation.reset()
        self.in_trouble.clear()
        for topics in self.robots.values():
            topics.restart()
        self.clock_due.restart()

    @service(Empty, "reset_simulation")
    async def reset(self, request: Empty.Request) -> Empty.Response:
        self.restart()
        return Empty.Response()

    @service(Empty, "pause_physics")
    async def pause(self, request: Empty.Request) -> Empty.Response:
        self.paused = True
        return Empty.Response()

    @service(Empty, "unpause_physics")
    async def unpause(self, request: Empty.Request) -> Empty.Response:
        self.paused = False
        return Empty.Response()


if __name__ == "__main__":
    graphflow.run(RobotSimulator)
