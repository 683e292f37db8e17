"""Type stubs for messages under ROS's names, whose classes exist only at run time.

`graphflow rclpy enable` writes them for the bundled packages, `graphflow interface stubs` for those of a workspace.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path

from graphflow.msgs import registry
from graphflow.rclpy.messages.classes import constant_value
from graphflow.rclpy.messages.values import SEQUENCE_CODES
from graphflow.wire.schema import INTEGER_RANGES, Action, FieldType, Message, Service

_HEAD = """\
# Written by graphflow; do not edit.

from array import array
from collections.abc import Sequence
from typing import Any, Final, TypeAlias

import numpy.typing as npt
"""
_SCALARS = {"bool": "bool", "byte": "bytes", "string": "str", "wstring": "str"}


def stubs(packages: Iterable[str], folder: Path) -> dict[Path, str]:
    """Return the text of the packages' stubs, by file.

    Args:
        packages: Their names; known to the registry.
        folder: One on the import path of Python or of a type checker.
    """
    found = {}
    for package in packages:
        kinds = [kind for kind in registry.KINDS if registry.names_in(package, kind)]
        if kinds:
            found[folder / package / "__init__.pyi"] = "# Written by graphflow; do not edit.\n"
            found[folder / package / "py.typed"] = ""
        for kind in kinds:
            found[folder / package / kind / "__init__.pyi"] = stub(package, kind)
    return found


def stub(package: str, kind: str) -> str:
    """Return the stub of a module such as `geometry_msgs.msg`."""
    names = registry.names_in(package, kind)
    body = "\n".join(text for name in names for text in _classes(f"{package}/{kind}/{name}"))
    others = sorted(set(re.findall(r"\b(\w+)\.msg\.[A-Z]", body)) - ({package} if kind == "msg" else set()))
    imports = "".join(f"import {other}.msg\n" for other in others)
    return f"{_HEAD}{imports}\n{body}"


def _classes(full_name: str) -> list[str]:
    name = full_name.rpartition("/")[2]
    match registry.interface(full_name):
        case Message() as message:
            return [_message(message)]
        case Service() as service:
            return [
                *map(_message, (service.request, service.response, service.event)),
                _holder(name, ("Request", "Response", "Event")),
            ]
        case Action() as action:
            parts = (action.goal, action.result, action.feedback, action.feedback_message)
            return [*map(_message, parts), _holder(name, ("Goal", "Result", "Feedback"))]


def _holder(name: str, parts: tuple[str, ...]) -> str:
    return "\n".join([f"class {name}:", *(f"    {part}: TypeAlias = {name}_{part}" for part in parts), ""])


def _message(message: Message) -> str:
    module, _, name = message.name.rpartition("/")
    lines = [f"class {name}:"]
    for constant in message.constants:
        value = constant_value(constant)
        literal = json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
        lines.append(f"    {constant.name}: Final = {literal}")
    for field in message.fields:
        if field.type.array:
            lines += [
                "    @property",
                f"    def {field.name}(self) -> {_getter_type(field.type, module)}: ...",
                f"    @{field.name}.setter",
                f"    def {field.name}(self, value: {_setter_type(field.type, module)}) -> None: ...",
            ]
        else:
            lines.append(f"    {field.name}: {_element(field.type.base, module)}")
    parameters = [f"{field.name}: {_setter_type(field.type, module)} = ..." for field in message.fields]
    lines.append(f"    def __init__({', '.join(['self', *(['*'] if parameters else []), *parameters])}) -> None: ...")
    lines.append("    @classmethod\n    def get_fields_and_field_types(cls) -> dict[str, str]: ...")
    return "\n".join([*lines, ""])


def _getter_type(type_: FieldType, module: str) -> str:
    """Return the type of an array that a field holds."""
    if type_.base not in SEQUENCE_CODES:
        return f"list[{_element(type_.base, module)}]"
    return "npt.NDArray[Any]" if type_.array == "fixed" else f"array[{_element(type_.base, module)}]"


def _setter_type(type_: FieldType, module: str) -> str:
    """Return the type that a field may be set to."""
    element = _element(type_.base, module)
    if not type_.array:
        return element
    is_numpys = type_.base in SEQUENCE_CODES and type_.array == "fixed"
    return f"Sequence[{element}]{' | npt.NDArray[Any]' if is_numpys else ''}"


def _element(base: str, module: str) -> str:
    if base in _SCALARS:
        return _SCALARS[base]
    if "/" not in base:
        return "int" if base in INTEGER_RANGES else "float"
    home, _, name = base.rpartition("/")
    return name if home == module else f"{home.replace('/', '.')}.{name}"
