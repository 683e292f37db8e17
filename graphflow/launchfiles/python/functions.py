"""Functions of ROS's launch packages that launch files, and substitutions and actions of their own, call.

Source: launch.utilities, launch.conditions, launch.frontend, launch_ros.utilities and ament_index_python.resources.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import PurePath
from typing import Any, TypeVar

from graphflow.launchfiles.python.stand_ins import OWN, RECORDING, PackageNotFoundError, Said, stand_in_of, text
from graphflow.markup.substitutions import truth

_T = TypeVar("_T")


class LaunchIntrospector(Said):
    """Shows what there is in a description."""

    kind = "LaunchIntrospector"

    def format_launch_description(self, description: Said) -> str:
        """The actions, each on a line."""
        return "\n".join(one.describe() for one in description.entities)


def normalize_to_list_of_substitutions(given: Any) -> list[Said]:
    """Texts, paths and substitutions, alone or in a list, as a list of substitutions.

    Raises:
        TypeError: There is something else among them.
    """
    match given:
        case Said():
            return [given]
        case str() | PurePath():
            return [stand_in_of("TextSubstitution")(text=str(given))]
        case Iterable():
            return [one for part in given for one in normalize_to_list_of_substitutions(part)]
    raise TypeError(f"expected a text, a substitution, or a list of them, got {given!r}")


def perform_substitutions(_context: Any, given: Any) -> str:
    """The text that substitutions make."""
    return RECORDING.known(text(given))


def evaluate_condition_expression(_context: Any, given: Any) -> bool:
    """The truth value of the text that substitutions make.

    Raises:
        SubstitutionError: It is neither true nor false.
    """
    return truth(RECORDING.known(text(given)), RECORDING.file)


def is_a(value: object, kind: type) -> bool:
    """As `isinstance`."""
    return isinstance(value, kind)


def is_a_subclass(value: Any, kind: type) -> bool:
    """As `issubclass`; also for an instance of the class."""
    return issubclass(value if isinstance(value, type) else type(value), kind)


def ensure_argument_type(value: object, kinds: Any, name: str, caller: str = "") -> None:
    """Refuse a value that is of none of some classes.

    Raises:
        TypeError: It is of none of them.
    """
    allowed = tuple(kinds) if isinstance(kinds, (list, tuple)) else (kinds,)
    if not isinstance(value, allowed):
        names = " or ".join(kind.__name__ for kind in allowed)
        raise TypeError(f"{f'{caller}: ' if caller else ''}{name}: expected {names}, got {value!r}")


def expose(_name: str) -> Any:
    """Leave a class as it is: launch files in XML and YAML have graphflow's own actions and substitutions."""

    def unchanged(exposed: _T) -> _T:
        return exposed

    return unchanged


def is_root_namespace(namespace: str) -> bool:
    """Whether it is that of all others."""
    return namespace == "/"


def is_namespace_absolute(namespace: str) -> bool:
    """Whether it stands for itself."""
    return namespace.startswith("/")


def make_namespace_absolute(namespace: str) -> str:
    """A namespace with the slash that it begins with."""
    return namespace if is_namespace_absolute(namespace) else f"/{namespace}"


def prefix_namespace(base: str | None, namespace: str | None) -> str | None:
    """A namespace below another, of which one may be missing."""
    if namespace is None or base is None:
        whole = base if namespace is None else namespace
    elif not base or is_namespace_absolute(namespace):
        whole = namespace
    else:
        whole = f"{base.rstrip('/')}/{namespace}"
    return whole if whole is None or is_root_namespace(whole) else whole.rstrip("/")


def has_resource(kind: str, name: str) -> str | bool:
    """The folder of a package, as the index of resources tells it; False if there is no such package or resource."""
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
