"""Command lines of the programs of a graph, with the name, remaps and parameters as ROS arguments."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from graphflow.graph.plan import PlannedNode
from graphflow.introspect.messages.echo import flow
from graphflow.names import split
from graphflow.workspace.source_kinds import uses_ros


def command_of(node: PlannedNode) -> list[str]:
    """Return the program of a planned node that has no class, and its arguments."""
    match node.command:
        case "graphflow", "run", *args if node.executable:
            command = [sys.executable, "-P", "-m", "graphflow.rclpy", *args]
        case "graphflow", *args:  # this one, whether or not it is on the PATH
            command = [sys.executable, "-P", "-m", "graphflow", *args]
        case (("python" | "python3"), script, *args) if script.endswith(".py") and uses_ros(Path(script)):
            command = [sys.executable, "-P", "-m", "graphflow.rclpy", script, *args]  # that Python may have no rclpy
        case program:
            command = list(program)
    return [*command, *(_ros_args(node) if node.executable else ())]


def signal_of(node: PlannedNode) -> str:
    """Return the signal that asks such a program to end: ROS 2's programs expect that of Ctrl-C."""
    return "SIGINT" if node.executable else "SIGTERM"


def _ros_args(node: PlannedNode) -> Iterator[str]:
    namespace, name = split(node.name)
    rules = [f"{rule.match}:={rule.replacement}" for rule in node.remaps]
    rules += [] if node.keeps_names else [f"__node:={name}"]
    rules += [f"__ns:={namespace}"] if namespace != "/" else []
    yield "--ros-args"
    for rule in rules:
        yield from ("-r", rule)
    for file in node.params_files:
        yield from ("--params-file", file)
    for parameter, setting in node.params.items():
        yield from ("-p", f"{parameter}:={flow(setting.value)}")
    if node.log_level:
        yield from ("--log-level", node.log_level)
