"""The namespace, remaps and parameter values with which a node begins, from its arguments and the program's."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from graphflow.errors import GraphflowError
from graphflow.names import Remap, Resolver
from graphflow.rclpy import node_bridge
from graphflow.rclpy.context_state import parse_only_ros
from rclpy._rclpy_pybind11 import RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState


class NodeArguments(NamedTuple):
    """The arguments of a node, read."""

    namespace: str
    remaps: list[Remap]
    """The node's own rules, then the program's."""
    values: dict[str, tuple[object, str]]
    """The parameter values, each with its source."""
    has_rosout: bool
    """Whether the arguments allow that its log is published on /rosout."""


def read_arguments(
    life: ContextState, name: str, namespace: str | None, cli_args: Sequence[str], *, use_global: bool
) -> NodeArguments:
    """Read the arguments of a new node.

    Args:
        life: The context, which has the program's arguments.
        name: The node's name before remapping.
        namespace: Its namespace; None for the root.
        cli_args: Its own ROS arguments.
        use_global: Whether the program's remaps and parameter values apply to it.

    Raises:
        RCLInvalidROSArgsError: ROS arguments are wrong.
        UnknownROSArgsError: An own argument is no ROS argument.
        InvalidNodeNameException, InvalidNamespaceException: A name is illegal.
    """
    try:
        own = parse_only_ros(cli_args)
    except GraphflowError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from None
    if own.unknown:
        raise UnknownROSArgsError(f"Found unknown ROS arguments: {own.unknown}")
    remaps = [*own.remaps, *(life.args.remaps if use_global else ())]
    relative = next((r for r in remaps if r.match == "__ns" and not r.replacement.startswith("/")), None)
    if relative is not None:
        way = f"a namespace begins with a slash: -r __ns:=/{relative.replacement}"
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: -r {relative}: {way}")
    space = namespace or "/"
    space = space if space.startswith("/") else f"/{space}"
    validate_node_name(name)
    validate_namespace(space)
    try:
        names = Resolver(name, space, remaps)
        values = node_bridge.overrides_for(life.args, names) if use_global else {}
        values |= node_bridge.overrides_for(own, names)  # of rules the first counts, of values the last
    except GraphflowError as error:
        raise RCLInvalidROSArgsError(str(error)) from None
    return NodeArguments(space, remaps, values, own.has_rosout and life.args.has_rosout)
