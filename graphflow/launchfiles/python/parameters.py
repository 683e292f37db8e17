"""The parameters of classes of ROS's launch packages: positional ones, then a bar, then keyword-only ones.

Source: the signatures of launch and launch_ros, of Humble, Jazzy and Rolling together. Classes that are not listed,
such as base classes for those of launch files, take anything.
"""

from __future__ import annotations

from collections.abc import ItemsView, Iterator, Mapping, Sequence
from typing import NamedTuple

from graphflow.names import did_you_mean

_ACTIONS = """
AppendEnvironmentVariable name value prepend separator |
DeclareLaunchArgument name | default_value description choices
EmitEvent | event
ForEach input_values | function
ForLoop length | function name
GroupAction actions | scoped forwarding launch_configurations
IncludeLaunchDescription launch_description_source | launch_arguments
LoadComposableNodes | composable_node_descriptions target_container
LogInfo | msg
OpaqueFunction | function args kwargs
PushROSNamespace namespace |
PushRosNamespace namespace |
RegisterEventHandler event_handler |
SetEnvironmentVariable name value |
SetLaunchConfiguration name value |
SetParameter name value |
SetParametersFromFile filename | node_name
SetRemap src dst |
SetUseSimTime value |
Shutdown | reason due_to_sigint
TimerAction | period actions cancel_on_shutdown
RosTimer | period actions cancel_on_shutdown
ROSTimer | period actions cancel_on_shutdown
"""
_OF_XML = {"exec": "executable", "pkg": "package", "ns": "namespace", "param": "parameters", "remap": "remappings"}
"""Parameters by their attribute names in XML and YAML launch files."""
_PROCESS = (
    "name prefix cwd env additional_env shell sigterm_timeout sigkill_timeout emulate_tty output output_format "
    "cached_output log_cmd on_exit respawn respawn_delay respawn_max_retries"
)
_NODE = f"{_PROCESS} package executable namespace exec_name parameters remappings arguments ros_arguments autostart"
_PROGRAMS = f"""
ExecuteProcess | cmd {_PROCESS}
Node | {_NODE}
LifecycleNode | {_NODE}
ComposableNodeContainer | {_NODE} composable_node_descriptions
ComposableNode | package plugin name namespace parameters remappings extra_arguments
"""
_OTHERS = """
AndSubstitution left right |
AnonName name |
AnyLaunchDescriptionSource launch_file_path |
Command command | on_stderr
EnvironmentVariable name | default_value
EqualsSubstitution left right |
ExecutableInPackage executable package |
FileContent path |
FindExecutable | name
FindPackagePrefix package |
FindPackageShare package |
IfCondition predicate_expression |
IfElseSubstitution condition if_value else_value |
LaunchConfiguration variable_name | default
LaunchConfigurationEquals launch_configuration_name expected_value |
LaunchConfigurationNotEquals launch_configuration_name expected_value |
LaunchDescription initial_entities | deprecated_reason
NotEqualsSubstitution left right |
NotSubstitution value |
OnExecutionComplete | target_action on_completion handle_once
OnProcessExit | target_action on_exit handle_once
OnProcessIO | target_action on_stdin on_stdout on_stderr handle_once
OnProcessStart | target_action on_start handle_once
OnShutdown | on_shutdown handle_once
OnStateTransition | entities target_lifecycle_node transition start_state goal_state matcher handle_once
OrSubstitution left right |
Parameter name value | value_type default
ParameterFile param_file | allow_substs
ParameterValue value | value_type
PathJoinSubstitution substitutions |
PathSubstitution path |
PythonExpression expression python_modules |
PythonLaunchDescriptionSource launch_file_path |
TextSubstitution | text
UnlessCondition predicate_expression |
XMLLaunchDescriptionSource launch_file_path |
YAMLLaunchDescriptionSource launch_file_path |
"""
_OF_PROCESSES = "name prefix cwd env additional_env cmd package executable namespace arguments ros_arguments"
_TEXTS = {
    "AppendEnvironmentVariable": "name value",
    "DeclareLaunchArgument": "name default_value choices",
    "EnvironmentVariable": "name default_value",
    **dict.fromkeys(("ExecuteProcess", "Node", "LifecycleNode", "ComposableNodeContainer"), _OF_PROCESSES),
    **dict.fromkeys(("IfCondition", "UnlessCondition"), "predicate_expression"),
    "IncludeLaunchDescription": "launch_arguments",
    "LogInfo": "msg",
    "PathJoinSubstitution": "substitutions",
    "PythonExpression": "expression",
    "SetEnvironmentVariable": "name value",
    "SetLaunchConfiguration": "name value",
}
"""Parameters that take texts and substitutions, perhaps in lists; launch refuses numbers there."""
_OF_LISTS = ("PathJoinSubstitution", "PythonExpression")
"""Substitutions of several parts, which are one list."""


class Parameters(NamedTuple):
    """The parameters of one class."""

    by_place: tuple[str, ...]
    by_name: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all parameters."""
        return self.by_place + self.by_name


def _read(text: str, *more: str) -> Iterator[tuple[str, Parameters]]:
    for line in filter(None, text.splitlines()):
        places, _, names = line.partition("|")
        kind, *by_place = places.split()
        yield kind, Parameters(tuple(by_place), (*names.split(), *more))


PARAMETERS = dict([*_read(_ACTIONS + _PROGRAMS, "condition"), *_read(_OTHERS)])
"""Parameters by class."""


def wrong(kind: str, given: Sequence[object], names: Sequence[str]) -> Iterator[str]:
    """Yield the faults of a call: too many positional arguments, and unknown keyword arguments.

    Args:
        given: The positional arguments.
        names: The names of the keyword arguments.
    """
    if kind not in PARAMETERS:
        return
    known = PARAMETERS[kind]
    if len(given) > len(known.by_place) and kind != "LaunchDescription":  # its own error lists all arguments
        one = given[len(known.by_place)]
        hint = f"; write {known.by_name[0]}={one!r}" if known.by_name else ""
        hint = "; write package=..., executable=..." if "executable" in known.names else hint
        if kind in _OF_LISTS:
            yield f"{kind} takes a list: write [ ] around {', '.join(map(repr, given))}"
            return
        yield f"{kind} takes {len(known.by_place) or 'nothing'} without a name, and not {one!r}{hint}"
    for name in sorted({*names} - {*known.names}):
        now = name.removeprefix("node_")  # the spelling of ROS 2's first distributions
        is_former = now != name and now in known.names
        hint = f"; it is called {now!r} now" if is_former else did_you_mean(name, (), hidden=known.names)
        if _OF_XML.get(name) in known.names:
            hint = f"; write {_OF_XML[name]}="
        yield f"{kind} has no argument {name!r}{hint}"


def not_texts(kind: str, given: Sequence[object], named: Mapping[str, object]) -> Iterator[str]:
    """Yield the faults of a call that passes numbers where launch takes texts only.

    Args:
        given: The positional arguments.
        named: The keyword arguments.
    """
    if kind not in _TEXTS:
        return
    values = {**dict(zip(PARAMETERS[kind].by_place, given, strict=False)), **named}
    for name in _TEXTS[kind].split():
        for number in _numbers(values.get(name)):
            text = str(number).lower() if isinstance(number, bool) else str(number)
            yield f"{kind}: {name} takes texts, and not {number!r}; write {text!r}"


def _numbers(value: object) -> Iterator[object]:
    """Yield the numbers in a value, which may be a list or a mapping."""
    if isinstance(value, (bool, int, float)):
        yield value
    elif isinstance(value, Mapping):
        yield from _numbers(value.items())
    elif isinstance(value, (list, tuple, ItemsView)):
        for one in value:
            yield from _numbers(one)
