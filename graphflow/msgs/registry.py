"""Finds interface definitions by name and keeps what has been made from them: schemas, hashes, classes, codecs."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any

from graphflow.errors import InterfaceError, UnknownInterface
from graphflow.msgs import build
from graphflow.msgs.values import checked
from graphflow.names import did_you_mean, nearest
from graphflow.reading import found_text
from graphflow.wire import idl
from graphflow.wire.cdr.codec import Codec
from graphflow.wire.cdr.codegen import FORMATS, Style, Types
from graphflow.wire.described import DESCRIBING, VALUES_BOUND, verified
from graphflow.wire.extent import extent
from graphflow.wire.profile import wire_profile, wire_type
from graphflow.wire.schema import NUMERIC, PRIMITIVES, STRINGS, Action, Interface, Message, Service
from graphflow.wire.typehash import referenced, type_hash

KINDS = ("msg", "srv", "action")
CALLED = {"msg": "a message", "srv": "a service", "action": "an action"}
HAVING_SHOWN = 4
"""Types of the same name that are named."""
BUNDLED = Path(__file__).parent
_SAME_DEFINITIONS = {"turtlesim_msgs": "turtlesim"}
"""Kilted moved turtlesim's interfaces to a package of their own: different names on the wire, the same text."""

_roots: list[Path] = []
_packages: dict[str, Path] = {}
"""Folders of single packages."""
_later: list[Callable[[], Mapping[str, Path]]] = []
"""What finds folders of more packages, and takes a while."""
_given: dict[str, str] = {}
"""Definitions from elsewhere, by name."""


def add_root(folder: Path) -> None:
    """Also search `folder`, a project's `interfaces/`, for packages."""
    if folder not in _roots:
        _roots.append(folder)


def add_package(name: str, folder: Path) -> None:
    """Make the definitions in a folder known as those of a package."""
    _packages.setdefault(name, folder)


def add_later(find: Callable[[], Mapping[str, Path]]) -> None:
    """Ask `find` for the folders of more packages once one is wanted that is not known."""
    _later.append(find)


def _look_further() -> bool:
    """Take what there is to be found; whether anybody was asked."""
    asked = bool(_later)
    while _later:
        for name, folder in _later.pop()().items():
            add_package(name, folder)
    return asked


def adopt(name: str, digest: str, sources: Mapping[str, str]) -> None:
    """Make a type known from definitions of somebody else. What is known here stands.

    Args:
        name: `package/kind/Name`.
        digest: The hash that it must have; empty for any.
        sources: The texts of its definition file and of the others', by type.

    Raises:
        InterfaceError: They are wrong, too large, of another hash, or do not go with what is known here.
    """
    new = {}
    for needed in verified(name, digest, sources):
        try:
            definition(needed)
        except UnknownInterface:
            new[needed] = sources[needed]
    _given.update(new)
    if digest and hash_of(name) != digest:
        for needed in new:
            del _given[needed]
        for memory in (interface, _part, message_schema, hash_of):  # no class or codec has been made of them
            memory.cache_clear()
        raise InterfaceError(f"{name}: types in it have other definitions here")


def definition(name: str) -> str:
    """The text that defines `package/kind/Name`.

    Raises:
        UnknownInterface: There is none; the text names the nearest.
        InterfaceError: It cannot be read.
    """
    if name in _given:
        return _given[name]
    path = definition_file(name)
    try:
        return found_text(path)
    except OSError as error:
        raise InterfaceError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InterfaceError(f"{path}: {error}") from None


def roots() -> Iterator[Path]:
    """Folders of packages: the bundled ones, those added, and every `interfaces/` where Python looks for modules.

    What a wire profile defines differently is in a folder of its name.
    """
    overlay = BUNDLED / wire_profile()
    if overlay.is_dir():
        yield overlay
    yield BUNDLED
    yield from _roots
    for entry in sys.path:
        folder = Path(entry or ".") / "interfaces"
        if folder not in _roots and folder.is_dir():
            yield folder


def package_folders(package: str) -> list[Path]:
    """The folders with definitions of `package`; empty when there is no such package."""
    name = _SAME_DEFINITIONS.get(package, package)
    if not name.isidentifier():
        return []
    folders = [root / name for root in roots()]
    if name in _packages:
        folders.append(_packages[name])
    found = [f for f in folders if any((f / kind).is_dir() for kind in KINDS)]
    return package_folders(package) if not found and _look_further() else found


def packages() -> list[str]:
    """The names of all packages that can be found."""
    _look_further()
    found = {f.name for root in roots() for f in root.iterdir() if f.is_dir() and package_folders(f.name)}
    found |= {name for name in _packages if package_folders(name)}
    found |= {alias for alias, name in _SAME_DEFINITIONS.items() if name in found}
    return sorted(found)


def names_in(package: str, kind: str) -> list[str]:
    """The names of a package's interfaces of one kind."""
    return sorted({f.stem for folder in package_folders(package) for f in (folder / kind).rglob(f"*.{kind}")})


def full_name(text: str) -> str:
    """`package/kind/Name` for `package/Name`, `package/kind/Name` or Python's `package.kind.Name`.

    Raises:
        UnknownInterface: There is no such interface, or the short form fits several kinds.
    """
    if _is_file(text) or text.partition("/")[0] in KINDS:
        raise UnknownInterface(f"{text!r} is not an interface name; {_meant(text)}")
    parts = text.replace(".", "/").split("/")
    if len(parts) == 3 and parts[0]:
        definition("/".join(parts))
        return "/".join(parts)
    if len(parts) != 2 or not parts[0]:
        raise UnknownInterface(f"{text!r} is not an interface name; {_meant(text)}")
    package, name = parts
    found = [kind for kind in KINDS if name in names_in(package, kind) or f"{package}/{kind}/{name}" in _given]
    if not found:
        raise UnknownInterface(_unknown(package, "", name, [n for k in KINDS for n in names_in(package, k)]))
    if len(found) > 1:
        raise UnknownInterface(f"{text!r} is a {' and a '.join(found)}; write {package}/{found[0]}/{name}")
    return f"{package}/{found[0]}/{name}"


def having(name: str) -> list[str]:
    """The types of that name in all packages, a few of them; `Twist` is `geometry_msgs/msg/Twist`."""
    found = (f"{package}/{kind}/{name}" for package in packages() for kind in KINDS if name in names_in(package, kind))
    return [one for one in found if one.partition("/")[0] not in _SAME_DEFINITIONS][:HAVING_SHOWN]


def _is_file(text: str) -> bool:
    """Whether a text ends as the file of a definition does, and is no module of Python's such as `std_msgs.msg`."""
    stem, _, ending = text.rpartition(".")
    return ending in KINDS and stem != "" and not package_folders(stem)


def _meant(text: str) -> str:
    """How the type is written that a text may be meant as, that is none: a name alone, or that of a file."""
    stem, kind = text.rpartition(".")[::2] if _is_file(text) else (text, "")
    *above, name = ["", *(part for part in stem.split("/") if part not in KINDS)]
    if not name.isidentifier():
        return "write package/msg/Name, for example std_msgs/msg/String"
    inside = [f"{p}/{k}/{name}" for p in above[-1:] for k in KINDS if name in names_in(p, k)]
    found = inside or having(name) or having(nearest(name, _all_names(), cutoff=0.8) or "")
    if found:
        return f"did you mean {' or '.join(map(repr, found))}?"
    return f"write package/{kind}/{name}" if kind else "write package/msg/Name, for example std_msgs/msg/String"


def _all_names() -> set[str]:
    return {name for package in packages() for kind in KINDS for name in names_in(package, kind)}


def _unknown(package: str, kind: str, name: str, known: list[str]) -> str:
    if not package_folders(package):
        return f"there is no interface package {package!r}{no_kinds(package) or did_you_mean(package, packages())}"
    found = [other for other in KINDS if name in names_in(package, other)]
    if found:
        written = f"{package}/{kind}/{name}"
        right = f"{package}/{found[0]}/{name}"
        return f"there is no {written}; " + (
            f"{name} is {CALLED[found[0]]}: {right}" if kind in KINDS else f"write {right}"
        )
    elsewhere = [] if misplaced(package, name) else having(name)
    if elsewhere and nearest(name, known, cutoff=0.8) is None:
        field = [f"{name.lower()} (of a field)"] if name.lower() in PRIMITIVES else []
        return f"package {package!r} has no interface {name!r}; did you mean {' or '.join(field + elsewhere)}?"
    return f"package {package!r} has no interface {name!r}{misplaced(package, name) or did_you_mean(name, known)}"


def no_kinds(package: str) -> str:
    """What a package's folder lacks, be it definitions or the package's name; empty if there is none."""
    if package in _packages:
        file = next((f for kind in KINDS for f in sorted(_packages[package].glob(f"*/*.{kind}"))), None)
        return f"; {file} must be {_packages[package] / file.suffix[1:] / file.name}" if file is not None else ""
    found = [root / package for root in roots() if package.isidentifier() and (root / package).is_dir()]
    if found:
        return f"; {found[0]} has no folder msg, srv or action"
    for root in roots():
        for kind in KINDS:
            for file in (*sorted((root / kind).glob(f"*.{kind}")), *sorted(root.glob(f"*.{kind}"))):
                return f"; {file} lies in no package: move it to {root / package / kind / file.name}"
    alike = (folder for root in roots() for folder in root.iterdir() if folder.name.replace("-", "_") == package)
    return next((f"; rename {folder} to {package}" for folder in alike if folder.is_dir()), "")


def misplaced(package: str, name: str) -> str:
    """What has to become of a file that seems to be meant, but lies elsewhere or is called otherwise; else empty.

    A file that is where and called as it must be is not meant to be renamed: then it is the name that is wrong.
    """
    folders = [root / package for root in roots()] + ([_packages[package]] if package in _packages else [])
    for folder in folders:
        for file in sorted(file for kind in KINDS for file in folder.rglob(f"*.{kind}")):
            kind = file.suffix[1:]
            if file.stem.replace("_", "").lower() == name.replace("_", "").lower():
                if file.parent == folder / kind and file.stem != name and idl.is_type_name(file.stem):
                    return f"; did you mean {file.stem!r}?"
                right = folder / kind / f"{name if idl.is_type_name(name) else camel(name)}.{kind}"
                if file != right:
                    return f"; {file} must be {right}{'' if idl.is_type_name(file.stem) else IN_CAMEL}"
    return ""


def why_different(name: str) -> str:
    """What may have happened where a node has another definition than the one here; for the end of a sentence."""
    try:
        file = definition_file(name)
    except UnknownInterface:
        return ""
    if file.is_relative_to(BUNDLED):
        return ""
    return f"; if {file} was changed after the node had started, start the node again"


def camel(name: str) -> str:
    """The name of an interface for one that has underscores or small letters: `SetGoal` for `set_goal`."""
    return "".join(part[:1].upper() + part[1:] for part in re.split("[_-]", name))


IN_CAMEL = ": names of interfaces are in camel case"
"""Why the file of an interface has to be renamed."""


def definition_file(name: str) -> Path:
    """The file that defines `package/kind/Name`.

    Raises:
        UnknownInterface: No file does; the text names the nearest.
    """
    package, kind, base = name.split("/")
    if kind in KINDS and base.isidentifier():
        for folder in package_folders(package):
            path = folder / kind / f"{base}.{kind}"
            if path.is_file():
                return path
            deeper = next((folder / kind).rglob(path.name), None)  # folders below are no part of the name
            if deeper is not None:
                return deeper
    raise UnknownInterface(_unknown(package, kind, base, names_in(package, kind)))


@cache
def interface(name: str) -> Interface:
    """The schema of `package/kind/Name`.

    Raises:
        UnknownInterface: There is no such definition.
        InterfaceError: Its text is wrong.
    """
    text = definition(name)
    try:
        return idl.parse(name, text)
    except InterfaceError as error:
        place = "" if name in _given else f"{definition_file(name)}: "
        raise InterfaceError(f"{place}{error}") from None


@cache
def message_schema(name: str) -> Message:
    """The schema of a message, including those derived from services and actions (`.../srv/Spawn_Request`).

    Raises:
        UnknownInterface, InterfaceError: As for `interface`; also when a type in it is wrong, contains itself, or is
            too deep in it.
    """
    extent(name, _part)
    return _part(name)


@cache
def _part(name: str) -> Message:
    _, kind, base = name.split("/")
    if kind == "msg":
        found = interface(name)
        assert isinstance(found, Message)
        return found
    owner = interface(_owner(name))
    if isinstance(owner, (Service, Action)):
        for part in owner.messages:
            if part.name == name:
                return part
    raise UnknownInterface(f"{owner.name} has no part {base!r}")


def _owner(name: str) -> str:
    """The interface whose file defines a type: of `package/srv/Spawn_Request`, the service."""
    package, kind, base = name.split("/")
    return name if kind == "msg" else f"{package}/{kind}/{base.partition('_')[0]}"


def service_schema(name: str) -> Service:
    """The schema of a service, including the two of an action (`.../action/Fibonacci_SendGoal`)."""
    owner = interface(_owner(name))
    if isinstance(owner, Service):
        return owner
    if isinstance(owner, Action):
        for service in owner.services:
            if service.name == name:
                return service
    raise UnknownInterface(f"{name} is not a service")


@cache
def has_number_lists(name: str) -> bool:
    """Whether a message type has arrays of numbers without a fixed size, as images and clouds have: it may be large.

    Arrays in the elements of lists do not count: those are many and small, as in parameters.
    """
    types = [field.type for field in message_schema(name).fields if field.type.base not in STRINGS]
    return any(
        type_.array in ("unbounded", "bounded")
        if type_.base in NUMERIC
        else not type_.array and has_number_lists(type_.base)
        for type_ in types
    )


def whole_schema(name: str) -> Message:
    """The type that stands for `name` in keys and tokens: a message itself, a service or action as a whole.

    Raises:
        UnknownInterface, InterfaceError: As for `interface`.
    """
    base = name.rpartition("/")[2]
    if name.rpartition("/")[0].endswith("/msg"):
        return message_schema(name)
    if base.endswith(("_SendGoal", "_GetResult")):
        return service_schema(name).whole
    if "_" in base:
        return message_schema(name)
    found = interface(name)
    assert not isinstance(found, Message)
    return found.whole


@cache
def hash_of(name: str) -> str:
    """RIHS01 of a message, or of a service or action as a whole."""
    return type_hash(whole_schema(name), message_schema)


@cache
def interface_class(name: str) -> type:
    """The Python class of `package/kind/Name`, or of a derived message; the one that the wire profile uses.

    Raises:
        UnknownInterface, InterfaceError: As for `interface`.
    """
    on_wire = wire_type(name, wire_profile())
    if on_wire != name:
        return interface_class(on_wire)
    if name.endswith(("_SendGoal", "_GetResult")):
        return build.service_class(service_schema(name), interface_class)
    if "/msg/" in name or "_" in name.rpartition("/")[2]:
        return build.message_class(message_schema(name), interface_class, partial(codec, name))
    found = interface(name)
    if isinstance(found, Service):
        return build.service_class(found, interface_class)
    assert isinstance(found, Action)
    return build.action_class(found, interface_class)


@cache
def codec(name: str) -> Codec:
    """The codec of a message."""
    return Codec(message_schema(name), _types_for(name, "numpy"))


@cache
def plain_codec(name: str) -> Codec:
    """The codec of a message that decodes numeric arrays into lists: slower for long ones, but numpy is not loaded."""
    return Codec(message_schema(name), _types_for(name, "list"))


def _types_for(name: str, style: Style) -> Types:
    """How a message is encoded and decoded: of a type from elsewhere, and of an answer with one, it may have less."""
    owner = _owner(name)
    types = Types(message_schema, interface_class, checked, style)
    return types._replace(values=VALUES_BOUND) if owner in _given or owner == DESCRIBING else types


def has_numeric_arrays(name: str) -> bool:
    """Whether a message type, or a part of a service or action, holds arrays of numbers, for which numpy is loaded."""
    whole = whole_schema(name)
    schemas = [whole, *referenced(whole, message_schema).values()]
    return any(field.type.array and field.type.base in FORMATS for schema in schemas for field in schema.fields)


def forget() -> None:
    """Re-read every definition from here on; classes already made stay as they are. For editors and tests."""
    for memory in (interface, _part, message_schema, hash_of, interface_class, codec, plain_codec):
        memory.cache_clear()


def prototype(name: str) -> Any:
    """What is filled in to use `package/kind/Name`: a message, a service's request, or an action's goal."""
    found = interface(name)
    part = found.request if isinstance(found, Service) else found.goal if isinstance(found, Action) else found
    return example(part.name)


def example(name: str) -> Any:
    """A message with every field at its default."""
    return interface_class(name)()
