"""Stubs of interfaces for editors and type checkers: `python -m graphflow.msgs.stubs` writes the bundled ones,
`graphflow interface stubs` for a project's own.

The classes are built at run time, so a checker cannot read them. A stub gives the types of an instance's fields and
the wider ones of the constructor's parameters: `base.Message` has the rules, `build.convert` follows them.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from graphflow.msgs import registry
from graphflow.msgs.build import ARITHMETIC
from graphflow.msgs.views import VIEWS
from graphflow.wire.schema import INTEGER_RANGES, NUMERIC, STRINGS, Action, Field, FieldType, Message, Service

_BUNDLED_HEADER = "# Written by `python -m graphflow.msgs.stubs`; do not edit.\n"
_PROJECT_HEADER = "# Written by `graphflow interface stubs`; do not edit.\n"
_LINE_LENGTH = 120
_TIMES = {f"builtin_interfaces/msg/{name}": f"times.{name}" for name in ("Time", "Duration")}
"""Message types with a counterpart in `graphflow.times` that has the same fields."""
_ARRAYS_FOR = {"bool": "np.bool_", "int": "np.integer", "float": "np.floating | np.integer"}
"""NumPy's scalar types that convert to an array field, by the Python type of its elements."""


def stub(package: str, kind: str, header: str = _BUNDLED_HEADER) -> str:
    """Return the stub of `graphflow.msgs.<package>.<kind>`; for a bundled package, of its bundled definitions only."""
    folder = registry.package_folders(package)[0] / kind
    names = sorted(file.stem for file in folder.rglob(f"*.{kind}"))
    body = "\n\n".join(text for name in names for text in _classes(f"{package}/{kind}/{name}"))
    return f"{header}\n{_imports(body)}\n\n{body}\n"


def bundled_stubs() -> dict[Path, str]:
    """Return the text of every stub of the bundled packages, by file."""
    return _stubs(registry.BUNDLED, registry.BUNDLED, _BUNDLED_HEADER)


def project_stubs(interfaces: Path, typings: Path) -> dict[Path, str]:
    """Return the text of every stub of a project's own packages, by file.

    Args:
        interfaces: The folder of their definitions, which the registry knows.
        typings: A folder that checkers search for stubs.
    """
    return _stubs(interfaces, typings / "graphflow" / "msgs", _PROJECT_HEADER)


def _stubs(root: Path, out: Path, header: str) -> dict[Path, str]:
    """Return stubs of the packages whose definitions are first found in `root`."""
    files = {}
    for package in registry.packages():
        definitions = registry.package_folders(package)[0]
        if definitions.parent != root:
            continue
        files[out / package / "__init__.pyi"] = header
        for kind in registry.KINDS:
            if (definitions / kind).is_dir():
                files[out / package / kind / "__init__.pyi"] = stub(package, kind, header)
    return files


def _imports(body: str) -> str:
    """Return the imports that `body` needs, in the linter's order. Nested types are qualified by their package."""
    words = set(re.findall(r"\w+", body))
    qualifiers = set(re.findall(r"\b(\w+)\.[A-Z]", body)) - {"np", "npt", "times", "base"}
    ours = [f"from graphflow.msgs.{package} import msg as {package}" for package in qualifiers]
    # As a module: an interface may be called Service.
    ours += ["from graphflow.msgs import base"]
    ours += ["from graphflow import times"] if "times." in body else []
    numpy = ["import numpy as np", "import numpy.typing as npt"] if "npt." in body else []
    standard = _import("collections.abc", ("Mapping", "Sequence"), words)
    standard += _import("typing", ("Any", "ClassVar", "Literal", "TypeAlias"), words)
    return "\n\n".join("\n".join(group) for group in (standard, numpy, sorted(ours)) if group)


def _import(module: str, names: tuple[str, ...], words: set[str]) -> list[str]:
    used = [name for name in names if name in words]
    return [f"from {module} import {', '.join(used)}"] if used else []


def _classes(full_name: str) -> list[str]:
    name = full_name.rpartition("/")[2]
    match registry.interface(full_name):
        case Message() as message:
            return [_message(message)]
        case Service() as service:
            return [*_service_messages(service), _holder(name, "Service", ("Request", "Response"), ("Event",))]
        case Action() as action:
            parts = (action.goal, action.result, action.feedback, action.feedback_message)
            carriers = [text for service in action.services for text in _service_messages(service)]
            holder = _holder(name, "Action", ("Goal", "Result", "Feedback"))
            handle = "    Handle: TypeAlias = base.ServerGoalHandle[Goal, Result, Feedback]"
            return [*map(_message, parts), *carriers, f"{holder}\n{handle}"]


def _service_messages(service: Service) -> list[str]:
    return [_message(part) for part in (service.request, service.response, service.event)]


def _holder(name: str, base: str, parts: tuple[str, ...], more: tuple[str, ...] = ()) -> str:
    """Return the class of a service or action. `TypeAlias` keeps checkers from reading its parts as variables."""
    aliases = [f"    {part}: TypeAlias = {name}_{part}" for part in (*parts, *more)]
    arguments = [f"{name}_{part}" for part in parts]
    head = f"class {name}(base.{base}[{', '.join(arguments)}]):"
    if len(head) > _LINE_LENGTH:
        head = "\n".join([f"class {name}(", f"    base.{base}[", *(f"        {a}," for a in arguments), "    ],", "):"])
    return "\n".join([head, *aliases])


def _message(message: Message) -> str:
    module, _, name = message.name.rpartition("/")
    constants = (f"{c.name}: ClassVar[{_constant(c.value)}]" for c in message.constants)
    attributes = (f"{f.name}: {_field_type(f.type, module)}" for f in message.fields)
    methods = [_constructor(message.fields, module)]
    if message.name in VIEWS:
        methods.append("def to_numpy(self) -> npt.NDArray[Any]: ...")
    bases = [*(f"times.{cls.__name__}" for cls in ARITHMETIC.get(message.name, ())), "base.Message"]
    return "\n    ".join([f"class {name}({', '.join(bases)}):", *constants, *attributes, *methods])


def _constant(value: bool | float | str) -> str:
    """Return the type of a constant. There are no literal types of floats."""
    if isinstance(value, float):
        return "float"
    return f"Literal[{json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)}]"


def _constructor(fields: tuple[Field, ...], module: str) -> str:
    parameters = [f"{field.name}: {_parameter_type(field.type, module)} = ..." for field in fields]
    line = f"def __init__(self{', *, ' if fields else ''}{', '.join(parameters)}) -> None: ..."
    if len(line) + 4 <= _LINE_LENGTH:
        return line
    return "\n        ".join(["def __init__(", "self,", "*,", *(f"{p}," for p in parameters)]) + "\n    ) -> None: ..."


def _field_type(type_: FieldType, module: str) -> str:
    """Return the type of a field's value, as written in the stub of `module` (`package/kind`)."""
    if not type_.array:
        return _element(type_.base, module)
    if type_.base in NUMERIC:
        scalar = {"bool": "bool_", "byte": "uint8", "char": "uint8"}.get(type_.base, type_.base)
        return f"npt.NDArray[np.{scalar}]"
    return f"list[{_element(type_.base, module)}]"


def _parameter_type(type_: FieldType, module: str) -> str:
    """Return the type of the constructor's parameter for a field. `Sequence[int]` covers bytes."""
    element = _element(type_.base, module)
    if type_.array and type_.base in NUMERIC:
        return f"Sequence[{element}] | npt.NDArray[{_ARRAYS_FOR[element]}]"
    if not type_.is_primitive:
        element = " | ".join(filter(None, (element, "Mapping[str, object]", _TIMES.get(type_.base))))
    elif type_.base in ("byte", "char"):
        element = "int | bytes"
    return f"Sequence[{element}]" if type_.array else element


def _element(base: str, module: str) -> str:
    if base in NUMERIC:
        return "bool" if base == "bool" else "int" if base in INTEGER_RANGES else "float"
    if base in STRINGS:
        return "str"
    home, _, name = base.rpartition("/")
    return name if home == module else f"{home.partition('/')[0]}.{name}"


def write(files: dict[Path, str]) -> None:
    """Write stubs to their files."""
    for file, text in files.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write(bundled_stubs())
