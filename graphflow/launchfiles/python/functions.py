"""Functions of ROS's launch packages, for launch files and for their own actions and substitutions.

Source: launch.utilities, launch.conditions, launch.frontend, launch_ros.utilities and ament_index_python.resources.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import PurePath
from typing import TypeVar

from graphflow.launchfiles.python.recording import RECORDING, PackageNotFoundError
from graphflow.launchfiles.python.stand_ins import OWN, RecordedCall, stand_in_of, text
from graphflow.markup.substitutions import truth

_T = TypeVar("_T")


class LaunchIntrospector(RecordedCall):
    """A tool that shows the actions of a description."""

    kind = "LaunchIntrospector"

    def format_launch_description(self, description: RecordedCall) -> str:
        """Return the actions, each on a line."""
        return "\n".join(one.describe() for one in description.entities if isinstance(one, RecordedCall))


def normalize_to_list_of_substitutions(given: object) -> list[RecordedCall]:
    """Convert texts, paths and substitutions, alone or in a list, to a list of substitutions.

    Raises:
        TypeError: A part is of another type.
    """
    match given:
        case RecordedCall():
            return [given]
        case str() | PurePath():
            return [stand_in_of("TextSubstitution")(text=str(given))]
        case Iterable():
            return [one for part in given for one in normalize_to_list_of_substitutions(part)]
    raise TypeError(f"expected a text, a substitution, or a list of them, got {given!r}")


def perform_substitutions(_context: object, given: object) -> str:
    """Return the text that substitutions make."""
    return RECORDING.known(text(given))


def evaluate_condition_expression(_context: object, given: object) -> bool:
    """Return the truth value of the text that substitutions make.

    Raises:
        SubstitutionError: The text is neither true nor false.
    """
    return truth(RECORDING.known(text(given)), RECORDING.file)


def is_a(value: object, kind: type) -> bool:
    """Return whether a value is an instance of a class."""
    return isinstance(value, kind)


def is_a_subclass(value: object, kind: type) -> bool:
    """Return whether a class, or the class of an instance, is a subclass of another."""
    return issubclass(value if isinstance(value, type) else type(value), kind)


def ensure_argument_type(value: object, kinds: type | Iterable[type], name: str, caller: str = "") -> None:
    """Check that a value is an instance of one of some classes.

    Raises:
        TypeError: It is an instance of none of them.
    """
    allowed = (kinds,) if isinstance(kinds, type) else tuple(kinds)
    if not isinstance(value, allowed):
        names = " or ".join(kind.__name__ for kind in allowed)
        raise TypeError(f"{f'{caller}: ' if caller else ''}{name}: expected {names}, got {value!r}")


def expose(_name: str) -> Callable[[_T], _T]:
    """Decorate a class without effect: launch files in XML and YAML have graphflow's own actions and substitutions."""

    def unchanged(exposed: _T) -> _T:
        return exposed

    return unchanged


def is_root_namespace(namespace: str) -> bool:
    """Return whether a namespace is the root."""
    return namespace == "/"


def is_namespace_absolute(namespace: str) -> bool:
    """Return whether a namespace begins with a slash."""
    return namespace.startswith("/")


def make_namespace_absolute(namespace: str) -> str:
    """Return a namespace with a leading slash."""
    return namespace if is_namespace_absolute(namespace) else f"/{namespace}"


def prefix_namespace(base: str | None, namespace: str | None) -> str | None:
    """Join two namespaces, of which either may be None."""
    if namespace is None or base is None:
        whole = base if namespace is None else namespace
    elif not base or is_namespace_absolute(namespace):
        whole = namespace
    else:
        whole = f"{base.rstrip('/')}/{namespace}"
    return whole if whole is None or is_root_namespace(whole) else whole.rstrip("/")


def has_resource(kind: str, name: str) -> str | bool:
    """Return the folder of a package by the resource index; False if the package or resource does not exist."""
    try:
        return RECORDING.folder("prefix", name) if kind == "packages" else False
    except PackageNotFoundError:
        return False


OWN |= {
    "LaunchIntrospector": LaunchIntrospector,
    "expose_action": expose,
    "expose_substitution": expose,
    **{
        function.__name__: function
        for function in (
            *(normalize_to_list_of_substitutions, perform_substitutions, evaluate_condition_expression),
            *(is_a, is_a_subclass, ensure_argument_type),
            *(is_root_namespace, is_namespace_absolute, make_namespace_absolute, prefix_namespace),
            has_resource,
        )
    },
}
