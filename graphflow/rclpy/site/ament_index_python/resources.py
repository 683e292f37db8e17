"""The resources that packages register in the index: their existence, and the interfaces that they define."""

from __future__ import annotations

from ament_index_python.packages import get_packages_with_prefixes
from graphflow.msgs import registry

TYPES = ("packages", "rosidl_interfaces")


class InvalidResourceTypeNameError(ValueError):
    """Not a legal name of a resource type."""


class InvalidResourceNameError(ValueError):
    """Not a legal name of a resource."""


def get_resource_types() -> set[str]:
    """Return the known resource types."""
    return set(TYPES)


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the resources of a type, each with its folder; empty for an unknown type.

    Raises:
        ValueError: Not a legal name of a resource type.
    """
    if not resource_type or "/" in resource_type or "\\" in resource_type:
        raise InvalidResourceTypeNameError(f"Resource type '{resource_type}' is invalid")
    interfaces = {name: str(registry.package_folders(name)[0]) for name in registry.packages()}
    match resource_type:
        case "packages":
            return {**interfaces, **get_packages_with_prefixes()}
        case "rosidl_interfaces":
            return interfaces
    return {}


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the content of a resource and its folder.

    Raises:
        ValueError: Not a legal name of a resource type, or of a resource.
        LookupError: No resource has that name.
    """
    folder = has_resource(resource_type, resource_name)
    if folder is False:
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    kinds = registry.KINDS if resource_type == "rosidl_interfaces" else ()
    names = [f"{kind}/{name}.{kind}" for kind in kinds for name in registry.names_in(resource_name, kind)]
    return "\n".join(names), str(folder)


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """Return the folder of a resource; False if there is none of that name. Raises ValueError."""
    if not resource_name or "/" in resource_name or "\\" in resource_name:
        raise InvalidResourceNameError(f"Resource name '{resource_name}' is invalid")
    return get_resources(resource_type).get(resource_name, False)
