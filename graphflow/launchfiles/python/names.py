"""The classes of ROS's launch packages by module, and their base classes. Source: `__all__` of the modules."""

from __future__ import annotations

NAMES = {
    "launch": "Action Condition Event EventHandler LaunchContext LaunchDescription LaunchDescriptionEntity "
    "LaunchDescriptionSource LaunchIntrospector LaunchService Substitution",
    "launch.actions": "AppendEnvironmentVariable DeclareLaunchArgument EmitEvent ExecuteLocal ExecuteProcess ForEach "
    "ForLoop GroupAction IncludeLaunchDescription LogInfo OpaqueCoroutine OpaqueFunction PopEnvironment "
    "PopLaunchConfigurations PushEnvironment PushLaunchConfigurations RegisterEventHandler ResetEnvironment "
    "ResetLaunchConfigurations SetEnvironmentVariable SetLaunchConfiguration Shutdown TimerAction "
    "UnregisterEventHandler UnsetEnvironmentVariable UnsetLaunchConfiguration",
    "launch.conditions": "IfCondition LaunchConfigurationEquals LaunchConfigurationNotEquals UnlessCondition",
    "launch.event_handlers": "OnExecutionComplete OnProcessExit OnProcessIO OnProcessStart OnShutdown",
    "launch.events": "ExecutionComplete IncludeLaunchDescription Shutdown TimerEvent matches_action",
    "launch.launch_description_sources": "AnyLaunchDescriptionSource FrontendLaunchDescriptionSource "
    "PythonLaunchDescriptionSource",
    "launch.substitutions": "AllSubstitution AndSubstitution AnonName AnySubstitution Command EnvironmentVariable "
    "EqualsSubstitution FileContent FindExecutable IfElseSubstitution LaunchConfiguration LaunchLogDir "
    "LocalSubstitution NotEqualsSubstitution NotSubstitution OrSubstitution PathJoinSubstitution PythonExpression "
    "TextSubstitution ThisLaunchFile ThisLaunchFileDir",
    "launch_ros.actions": "ComposableNodeContainer LifecycleNode LifecycleTransition LoadComposableNodes Node "
    "PushROSNamespace PushRosNamespace ROSTimer RosTimer SetParameter SetParametersFromFile SetROSLogDir SetRemap "
    "SetUseSimTime",
    "launch_ros.descriptions": "ComposableNode Parameter ParameterFile ParameterValue",
    "launch_ros.substitutions": "ExecutableInPackage FindPackagePrefix FindPackageShare Parameter",
}
"""The names that `from MODULE import *` imports, by module."""

_BASES = {
    "launch.actions": "Action",
    "launch.conditions": "Condition",
    "launch.event_handlers": "EventHandler",
    "launch.substitutions": "Substitution",
    "launch_ros.actions": "Action",
    "launch_ros.substitutions": "Substitution",
}
BASES = {
    **{name: base for module, base in _BASES.items() for name in NAMES[module].split()},
    "ExecuteProcess": "ExecuteLocal",
    "Node": "ExecuteProcess",
    "LifecycleNode": "Node",
    "ComposableNodeContainer": "Node",
    "UnlessCondition": "IfCondition",
    "LaunchConfigurationNotEquals": "LaunchConfigurationEquals",
    "RosTimer": "TimerAction",
    "ROSTimer": "TimerAction",
    "ExecutableInPackage": "FindPackagePrefix",
    "PathSubstitution": "Substitution",
    "PythonLaunchDescriptionSource": "LaunchDescriptionSource",
    "AnyLaunchDescriptionSource": "LaunchDescriptionSource",
    "FrontendLaunchDescriptionSource": "LaunchDescriptionSource",
    **dict.fromkeys(("Action", "LaunchDescription"), "LaunchDescriptionEntity"),
}
"""The base class of each class, for `isinstance` in launch files."""


def home(module: str, name: str) -> str | None:
    """Return the right module for a class that is imported from a wrong one; None if the import may be right.

    Modules that are not listed here, such as submodules, may have any class.
    """
    if module not in {*NAMES, "launch_ros"} or name in NAMES.get(module, "").split():
        return None
    return next((other for other, names in NAMES.items() if name in names.split()), None)
