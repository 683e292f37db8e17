"""The available interfaces: those bundled with graphflow, and those of the workspace."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from graphflow.msgs import registry
from graphflow.rclpy.messages import finder


def get_interface_packages() -> dict[str, str]:
    """Return the packages that have interfaces, with their folders."""
    _take_workspace()
    return {package: str(registry.package_folders(package)[0]) for package in registry.packages()}


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the interfaces of packages, as `msg/String`; of all if none is named. Raises LookupError."""
    return _of_kinds(package_names, registry.KINDS)


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the messages. Arguments and errors as for `get_interfaces`."""
    return _of_kinds(package_names, ("msg",))


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the services. Arguments and errors as for `get_interfaces`."""
    return _of_kinds(package_names, ("srv",))


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the actions. Arguments and errors as for `get_interfaces`."""
    return _of_kinds(package_names, ("action",))


def get_interface_path(interface_name: str) -> str:
    """Return the file of a definition such as `std_msgs/msg/String`, given with or without its suffix.

    Raises:
        ValueError: Not the name of an interface.
        LookupError: No interface has that name.
    """
    package, _, rest = interface_name.partition("/")
    kind, _, name = rest.partition("/")
    if not (package and kind and name):
        raise ValueError(f"Invalid name '{interface_name}'. Expected package/kind/Name, such as std_msgs/msg/String")
    if package not in get_interface_packages():
        raise LookupError(f"Unknown package '{package}'")
    for folder in registry.package_folders(package):
        file = Path(folder, kind, name if "." in name else f"{name}.{kind}")
        if file.is_file():
            return str(file)
    raise LookupError(f"Could not find the interface '{interface_name}'")


def _of_kinds(package_names: Iterable[str], kinds: Iterable[str]) -> dict[str, list[str]]:
    known = get_interface_packages()
    found = {}
    for package in list(package_names) or known:
        if package not in known:
            raise LookupError(f"Unknown package '{package}'")
        names = [f"{kind}/{name}" for kind in kinds for name in registry.names_in(package, kind)]
        if names:
            found[package] = names
    return found


def _take_workspace() -> None:
    for package, folder in finder.KNOWN.items():
        registry.add_package(package, Path(folder))
