"""What `from launch.actions import *` brings, of the modules of ROS's launch packages. Source: their `__all__`."""

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
    "PushROSNamespace PushRosNamespace RosTimer SetParameter SetParametersFromFile SetROSLogDir SetRemap SetUseSimTime",
    "launch_ros.substitutions": "ExecutableInPackage FindPackagePrefix FindPackageShare Parameter",
}
"""By module."""
