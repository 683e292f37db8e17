"""The part of a node that manages its parameters."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from graphflow.analysis.user_code import place_in
from graphflow.rclpy import node_bridge
from graphflow.rclpy.context_state import LOOP
from graphflow.rclpy.hints.lookup import hint
from graphflow.rclpy.parameter_answers import ParameterAnswers
from rclpy.impl.callers import caller
from rclpy.impl.internals import Internals, Known
from rclpy.impl.mistakes.arguments import explained
from rclpy.impl.parameters import RELATIVE_TOLERANCE
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameter_events, qos_profile_parameters
from rclpy.time_source import TimeSource

if TYPE_CHECKING:
    from rcl_interfaces.msg import Parameter as ParameterMessage
    from rcl_interfaces.msg import ParameterDescriptor, ParameterValue, SetParametersResult
    from rcl_interfaces.srv import SetParameters, SetParametersAtomically

    from rclpy.node import Node

logger = logging.getLogger("graphflow")


class ParameterMethods:
    """The node's methods for its parameters; a base class of `Node`."""

    PARAM_REL_TOL = RELATIVE_TOLERANCE
    _parameters = Known(lambda inner: inner.parameters.with_prefix(""))
    _graphflow: Internals

    @property
    def _graphflow_as_node(self) -> Node:
        return cast("Node", self)

    def _graphflow_open_parameters(self, has_services: bool) -> None:
        from rcl_interfaces.msg import ParameterEvent
        from rcl_interfaces.srv import SetParameters, SetParametersAtomically

        inner, node = self._graphflow, self._graphflow_as_node
        # First: the declarations below are announced there, as in rclpy.
        inner.events = node.create_publisher(ParameterEvent, "/parameter_events", qos_profile_parameter_events)
        inner.time_source = TimeSource(node=node)
        # After the node, whose `use_sim_time` decides how the clock begins.
        inner.time_source.attach_clock(inner.clock)
        if not self.has_parameter("start_type_description_service"):
            self.declare_parameter("start_type_description_service", True)
        if self.get_parameter("start_type_description_service").value:
            LOOP.call(node_bridge.describe_types, inner.node)
        if has_services:
            answers = ParameterAnswers(inner.parameters)
            LOOP.call(answers.serve, inner.core)
            options: dict[str, Any] = {"qos_profile": qos_profile_parameters}
            base = node.get_name()
            node.create_service(SetParameters, f"{base}/set_parameters", self._graphflow_serve_set, **options)
            all_name = f"{base}/set_parameters_atomically"
            node.create_service(SetParametersAtomically, all_name, self._graphflow_serve_set_all, **options)

    def _graphflow_declare_overrides(self) -> None:
        from rcl_interfaces.msg import ParameterDescriptor

        parameters = self._graphflow.parameters
        wanted = [
            (name, parameter.value, ParameterDescriptor(dynamic_typing=True))
            for name, parameter in parameters.overrides.items()
            if name not in parameters.values
        ]
        parameters.declare("", wanted)

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: ParameterDescriptor | None = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter.

        Args:
            value: The default, or the type; an override takes precedence over a default.
            ignore_override: Whether to ignore overrides.

        Raises:
            ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterTypeException,
            InvalidParameterValueException: See their docstrings.
        """
        given: tuple[object, ...] = (name, value) if descriptor is None else (name, value, descriptor)
        given = (name,) if value is None and descriptor is None else given
        return self._graphflow.parameters.declare("", [given], ignore_override=ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Sequence[Sequence[object]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare several parameters: (name,), (name, value or type) or (name, value or type, descriptor) each."""
        return self._graphflow.parameters.declare(namespace, parameters, ignore_override=ignore_override)

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter. Raises ParameterNotDeclaredException, ParameterImmutableException."""
        self._graphflow.parameters.undeclare(name)

    def has_parameter(self, name: str) -> bool:
        return name in self._graphflow.parameters.values

    def get_parameter_types(self, names: list[str]) -> list[Parameter.Type]:
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter_type(name) for name in names]

    def get_parameter_type(self, name: str) -> Parameter.Type:
        """Return the type of a parameter. Raises ParameterNotDeclaredException."""
        parameters = self._graphflow.parameters
        if name in parameters.values:
            return parameters.values[name].type_
        return parameters.get(name).type_

    def get_parameters(self, names: list[str]) -> list[Parameter]:
        if not all(isinstance(name, str) for name in names):
            raise TypeError("All names must be instances of type str")
        return [self.get_parameter(name) for name in names]

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter. Raises ParameterNotDeclaredException, ParameterUninitializedException."""
        return self._graphflow.parameters.get(name)

    def get_parameter_or(self, name: str, alternative_value: Parameter | None = None) -> Parameter:
        """Return a parameter, or the alternative if it was not declared or has no value."""
        if alternative_value is None:
            alternative_value = Parameter(name, Parameter.Type.NOT_SET)
        found = self._graphflow.parameters.values.get(name)
        return alternative_value if found is None or found.type_ is Parameter.Type.NOT_SET else found

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below a prefix, by the rest of their names."""
        return self._graphflow.parameters.with_prefix(prefix)

    @explained
    def set_parameters(self, parameter_list: list[Parameter]) -> list[SetParametersResult]:
        """Set parameters one after the other. Raises ParameterNotDeclaredException before setting any."""
        return self._graphflow_log_failures(self._graphflow.parameters.set_each(parameter_list), parameter_list)

    @explained
    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set all parameters or none. Raises ParameterNotDeclaredException."""
        return self._graphflow_log_failures([self._graphflow.parameters.set_all(parameter_list)], parameter_list)[0]

    def _graphflow_log_failures(
        self, results: list[SetParametersResult], given: Sequence[Parameter]
    ) -> list[SetParametersResult]:
        """Log the parameters that were not set, if the calling code drops the result."""
        faults = [result.reason or "(the callback gave no reason)" for result in results if not result.successful]
        asked = caller(3) if faults else None  # 3: past `checked` of `explained`
        if asked is not None and asked.drops_result:
            names = ", ".join(p.name for p in given) if len(results) == 1 else "some parameters"
            text = "%s: %s was not set, and the result that reports it is ignored: %s"
            logger.warning(text, asked.place, names, "; ".join(faults))
        return results

    def list_parameters(self, prefixes: list[str], depth: int) -> object:
        """List the names below prefixes, at most `depth` levels; 0 for any."""
        return self._graphflow.parameters.listed(prefixes, depth)

    @explained
    def add_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], list[Parameter]]) -> None:
        """Register `callback`, which may change the list of parameters before they are set."""
        # At the front, as in rclpy: the last one added is the first to be called.
        self._graphflow.parameters.before.insert(0, callback)

    @explained
    def add_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], SetParametersResult]) -> None:
        """Register `callback`, which decides whether parameters may be set."""
        self._graphflow.parameters.checks.insert(0, callback)

    @explained
    def add_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], None]) -> None:
        """Register `callback`, which is notified after parameters were set."""
        self._graphflow.parameters.after.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: Callable[..., Any]) -> None:
        """Remove such a callback. Raises ValueError if it was not added."""
        self._graphflow.parameters.before.remove(callback)

    def remove_on_set_parameters_callback(self, callback: Callable[..., Any]) -> None:
        """Remove such a callback. Raises ValueError if it was not added."""
        self._graphflow.parameters.checks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: Callable[..., Any]) -> None:
        """Remove such a callback. Raises ValueError if it was not added."""
        self._graphflow.parameters.after.remove(callback)

    # The lists of callbacks, under the names that rclpy has for them.

    @property
    def _pre_set_parameters_callbacks(self) -> list[Any]:
        return self._graphflow.parameters.before

    @property
    def _on_set_parameters_callbacks(self) -> list[Any]:
        return self._graphflow.parameters.checks

    @property
    def _post_set_parameters_callbacks(self) -> list[Any]:
        return self._graphflow.parameters.after

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return a parameter's descriptor. Raises ParameterNotDeclaredException."""
        return self._graphflow.parameters.describe(name)

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self, name: str, descriptor: ParameterDescriptor, alternative_value: ParameterValue | None = None
    ) -> ParameterValue:
        """Replace a parameter's descriptor, and set `alternative_value` if given; return the value."""
        found: ParameterValue = self._graphflow.parameters.set_descriptor(name, descriptor, alternative_value)
        return found

    def _graphflow_parameters_changed(self, parameters: list[Parameter], former: Mapping[str, Parameter]) -> None:
        from rcl_interfaces.msg import ParameterEvent

        events = self._graphflow.events
        # While the node is being constructed or destroyed.
        if events is None:
            return
        event = ParameterEvent(stamp=self._graphflow.clock.now().to_msg(), node=self._graphflow.node.full_name)
        for parameter in parameters:
            message = parameter.to_parameter_msg()
            if parameter.type_ is Parameter.Type.NOT_SET:
                if parameter.name in former:
                    event.deleted_parameters.append(former[parameter.name].to_parameter_msg())
            elif parameter.name in former:
                event.changed_parameters.append(message)
            else:
                event.new_parameters.append(message)
        events.publish(event)

    def _graphflow_serve_set(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> SetParameters.Response:
        response.results = [self._graphflow_set_messages([parameter]) for parameter in request.parameters]
        return response

    def _graphflow_serve_set_all(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        response.result = self._graphflow_set_messages(request.parameters)
        return response

    def _graphflow_warn_of_no_effect(self, former: Mapping[str, Parameter]) -> None:
        """Warn, once for each, of parameters that another process has set, and that only the constructor reads."""
        parameters = self._graphflow.parameters
        for name, parameter in list(parameters.values.items()):
            if name in former and former[name].value != parameter.value and name not in parameters.examined:
                parameters.examined.add(name)
                from rclpy.impl.mistakes.read_once import without_effect  # most nodes never need it

                if text := without_effect(type(self), name):
                    self._graphflow_as_node.get_logger().warning(text)

    def _graphflow_set_messages(self, given: Sequence[ParameterMessage]) -> SetParametersResult:
        from rcl_interfaces.msg import SetParametersResult

        try:
            former = dict(self._graphflow.parameters.values)
            wanted = [Parameter.from_parameter_msg(message) for message in given]
            result = self.set_parameters_atomically(wanted)
            if result.successful:
                self._graphflow_warn_of_no_effect(former)
            return result
        except Exception as error:  # a user's check may raise anything: the client gets its text, the log its place
            place, note = place_in(error), hint(error)
            text = f"{Path(place).name}: {type(error).__name__}: {error}{note and '; '}{note}" if place else str(error)
            if place or isinstance(error, AttributeError):  # the others are the client's
                self._graphflow_as_node.get_logger().error(f"parameters were not set: {text}")
            return SetParametersResult(successful=False, reason=str(error))
