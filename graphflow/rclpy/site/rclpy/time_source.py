"""Simulated time: messages on /clock set a node's clocks while its parameter `use_sim_time` is true.

/clock is received on a thread of its own, so that time goes on while a callback sleeps by it.
"""

from __future__ import annotations

import threading
import weakref
from typing import TYPE_CHECKING, Any

from graphflow.rclpy import node_bridge
from graphflow.rclpy.context_state import LOOP
from graphflow.rclpy.messages import classes
from graphflow.rclpy.node_bridge import NodeBell
from graphflow.rclpy.wake import Wake
from graphflow.runtime.endpoints.threaded import ThreadedSubscription
from rclpy._rclpy_pybind11 import InvalidHandle
from rclpy.clock import ROSClock
from rclpy.clock_type import ClockType
from rclpy.impl.nodes import internals_of
from rclpy.impl.reexports import passed_on
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy, to_graphflow
from rclpy.time import Time

if TYPE_CHECKING:
    import rosgraph_msgs.msg
    from rcl_interfaces.msg import SetParametersResult

    from graphflow.runtime.node_core import NodeCore
    from rclpy.node import Node

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"
_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class TimeSource:
    """Sets the attached clocks to simulated time."""

    def __init__(self, *, node: Node | None = None) -> None:
        self._clock_sub: _Hearing | None = None
        self._node: weakref.ref[Node] | None = None
        self._clocks: list[ROSClock] = []
        self._is_active = False
        self._last = Time(clock_type=ClockType.ROS_TIME)
        if node is not None:
            self.attach_node(node)

    @property
    def last_ns(self) -> int:
        """The last time received on /clock, in nanoseconds; 0 before the first. graphflow's own."""
        return self._last.nanoseconds

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clocks follow /clock."""
        return self._is_active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if self._is_active is enabled:
            return
        self._is_active = enabled
        for clock in self._clocks:
            clock.activate_override(enabled)
        self._hear()

    def _hear(self) -> None:
        node = self._get_node()
        if self._is_active and node is not None and self._clock_sub is None:
            self._clock_sub = _Hearing(node, self)
        elif not self._is_active and self._clock_sub is not None:
            self._clock_sub.close()
            self._clock_sub = None

    def attach_node(self, node: Node) -> None:
        """Follow a node's parameter `use_sim_time`, declaring it if necessary. Raises TypeError if it is not a node."""
        if not hasattr(node, "declare_parameter"):
            raise TypeError("Node must be of type rclpy.node.Node")
        if self._node is not None:
            self.detach_node()
        self._node = weakref.ref(node)
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        value = node.get_parameter(USE_SIM_TIME_NAME)
        if value.type_ is Parameter.Type.BOOL:
            self.ros_time_is_active = value.value
        else:
            node.get_logger().error(f"Invalid type for parameter '{USE_SIM_TIME_NAME}' {value.type_!r} should be bool")
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._set)

    def detach_node(self) -> None:
        """Stop following the node."""
        if self._clock_sub is not None:
            self._clock_sub.close()
            self._clock_sub = None
        node = self._get_node()
        if node is not None:
            node.remove_on_set_parameters_callback(self._check)
            node.remove_post_set_parameters_callback(self._set)
        self._node = None
        self.ros_time_is_active = False

    def attach_clock(self, clock: ROSClock) -> None:
        """Attach a clock. Raises ValueError if it is not of ROS time."""
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        # Before the clock is activated: it would show an older time for a moment otherwise.
        clock.set_ros_time_override(self._last)
        clock.activate_override(self._is_active)
        self._clocks.append(clock)

    def clock_callback(self, msg: rosgraph_msgs.msg.Clock) -> None:
        """Set the clocks to a message's time."""
        self._last = Time.from_msg(msg.clock)
        for clock in self._clocks:
            clock.set_ros_time_override(self._last)

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameters:
            if parameter.name == USE_SIM_TIME_NAME and parameter.type_ is not Parameter.Type.BOOL:
                reason = f"{USE_SIM_TIME_NAME} parameter set to something besides a bool"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _set(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == USE_SIM_TIME_NAME:
                self.ros_time_is_active = parameter.value

    def _get_node(self) -> Node | None:
        return None if self._node is None else self._node()


class _Waking(NodeBell):
    """A bell that wakes one thread."""

    def __init__(self) -> None:
        super().__init__()
        self.wakes = Wake()

    def ring(self) -> None:
        self.pending = True
        self.wakes.set()


class _Hearing:
    """A subscription of /clock, and the thread that takes its messages."""

    def __init__(self, node: Node, source: TimeSource) -> None:
        import rosgraph_msgs.msg

        self._type, self._source = rosgraph_msgs.msg.Clock, source
        self._bell, self._is_closed = _Waking(), False
        name = node.resolve_topic_name(CLOCK_TOPIC)

        def make(core: NodeCore) -> ThreadedSubscription:
            made = ThreadedSubscription(core, self._type, name, to_graphflow(_QOS), self._bell, _nothing)
            # Hidden from reports and views of the user's own callbacks.
            made.is_inner = True
            return made

        self._endpoint = node_bridge.add(internals_of(node).node, make)
        threading.Thread(target=self._listen, name="graphflow-clock", daemon=True).start()

    def _listen(self) -> None:
        while not self._is_closed:
            self._bell.wakes.wait()
            self._bell.attend()
            while (taken := self._endpoint.take()) is not None and not self._is_closed:
                try:
                    self._source.clock_callback(classes.decode(self._type, taken.payload))
                except InvalidHandle:  # a clock that was destroyed
                    continue

    def close(self) -> None:
        self._is_closed = True
        self._bell.ring()
        LOOP.call(self._endpoint.close)


def _nothing() -> None:
    """Do nothing: the thread takes every message."""


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
