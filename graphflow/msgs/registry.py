"""The registry of interfaces: finds definitions by name and caches schemas, hashes, classes and codecs."""

from __future__ import annotations

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

KINDS = idl.KINDS
CALLED = {"msg": "a message", "srv": "a service", "action": "an action"}
HAVING_SHOWN = 4
"""Number of types of the same name that an error lists."""
BUNDLED = Path(__file__).parent
_SAME_DEFINITIONS = {"turtlesim_msgs": "turtlesim"}
"""Kilted moved turtlesim's interfaces to a package of their own: different names on the wire, the same definitions."""

_roots: list[Path] = []
_packages: dict[str, Path] = {}
"""Folders of single packages."""
_later: list[Callable[[], Mapping[str, Path]]] = []
"""Slow searches for the folders of more packages."""
_foreign: dict[str, str] = {}
"""Definitions from other processes and bags, by name."""


def add_root(folder: Path) -> None:
    """Also search `folder`, a project's `interfaces/`, for packages."""
    if folder not in _roots:
        _roots.append(folder)


def add_package(name: str, folder: Path) -> None:
    """Register the definitions in a folder as those of a package."""
    _packages.setdefault(name, folder)


def add_later(find: Callable[[], Mapping[str, Path]]) -> None:
    """Register a slow search for packages, which runs when an unknown one is needed."""
    _later.append(find)


def _search_more() -> bool:
    """Run the registered searches; returns whether there were any."""
    has_searches = bool(_later)
    while _later:
        for name, folder in _later.pop()().items():
            add_package(name, folder)
    return has_searches


def adopt(name: str, digest: str, sources: Mapping[str, str]) -> None:
    """Register a type from foreign definitions. Known types take precedence.

    Args:
        name: `package/kind/Name`.
        digest: The hash that it must have; empty for any.
        sources: The definition texts of the type and of its nested types, by type.

    Raises:
        InterfaceError: They are wrong, too large, of another hash, or contradict known types.
    """
    new = {}
    for needed in verified(name, digest, sources):
        try:
            definition(needed)
        except UnknownInterface:
            new[needed] = sources[needed]
    _foreign.update(new)
    if digest and hash_of(name) != digest:
        for needed in new:
            del _foreign[needed]
        for memory in (interface, _part, message_schema, hash_of):  # no class or codec has been built from them
            memory.cache_clear()
        raise InterfaceError(f"{name}: its nested types have other definitions here")


def definition(name: str) -> str:
    """Return the text that defines `package/kind/Name`.

    Raises:
        UnknownInterface: There is no definition; the text names the nearest.
        InterfaceError: It cannot be read.
    """
    if name in _foreign:
        return _foreign[name]
    path = definition_file(name)
    try:
        return found_text(path)
    except OSError as error:
        raise InterfaceError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InterfaceError(f"{path}: {error}") from None


def roots() -> Iterator[Path]:
    """Yield the folders of packages: the bundled ones, registered ones, and every `interfaces/` on sys.path.

    Definitions that differ in a wire profile are in a folder of its name.
    """
    # First, so that its definitions take precedence.
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
    """Return the folders with definitions of `package`; empty if there is no such package."""
    name = _SAME_DEFINITIONS.get(package, package)
    if not name.isidentifier():
        return []
    folders = [root / name for root in roots()]
    if name in _packages:
        folders.append(_packages[name])
    found = [f for f in folders if any((f / kind).is_dir() for kind in KINDS)]
    return package_folders(package) if not found and _search_more() else found


def packages() -> list[str]:
    """Return the names of all packages that can be found."""
    _search_more()
    found = {f.name for root in roots() for f in root.iterdir() if f.is_dir() and package_folders(f.name)}
    found |= {name for name in _packages if package_folders(name)}
    found |= {alias for alias, name in _SAME_DEFINITIONS.items() if name in found}
    return sorted(found)


def names_in(package: str, kind: str) -> list[str]:
    """Return the names of a package's interfaces of one kind."""
    return sorted({f.stem for folder in package_folders(package) for f in (folder / kind).rglob(f"*.{kind}")})


def full_name(text: str) -> str:
    """Return `package/kind/Name` for `package/Name`, `package/kind/Name` or Python's `package.kind.Name`.

    Raises:
        UnknownInterface: There is no such interface, or the short form fits several kinds.
    """
    if _is_file(text) or text.partition("/")[0] in KINDS:
        raise UnknownInterface(f"{text!r} is not an interface name; {_suggestion(text)}")
    parts = text.replace(".", "/").split("/")
    if len(parts) == 3 and parts[0]:
        definition("/".join(parts))
        return "/".join(parts)
    if len(parts) != 2 or not parts[0]:
        raise UnknownInterface(f"{text!r} is not an interface name; {_suggestion(text)}")
    package, name = parts
    found = [kind for kind in KINDS if name in names_in(package, kind) or f"{package}/{kind}/{name}" in _foreign]
    if not found:
        raise UnknownInterface(_unknown(package, "", name, [n for k in KINDS for n in names_in(package, k)]))
    if len(found) > 1:
        raise UnknownInterface(f"{text!r} is a {' and a '.join(found)}; write {package}/{found[0]}/{name}")
    return f"{package}/{found[0]}/{name}"


def having(name: str) -> list[str]:
    """Return a few of the types with a name, in all packages; `Twist` is `geometry_msgs/msg/Twist`."""
    found = (f"{package}/{kind}/{name}" for package in packages() for kind in KINDS if name in names_in(package, kind))
    return [one for one in found if one.partition("/")[0] not in _SAME_DEFINITIONS][:HAVING_SHOWN]


def _is_file(text: str) -> bool:
    """Return whether a text ends like the file of a definition, and is not a Python module such as `std_msgs.msg`."""
    stem, _, ending = text.rpartition(".")
    return ending in KINDS and stem != "" and not package_folders(stem)


def _suggestion(text: str) -> str:
    """Return the type that a wrong text may mean: a name without package, or that of a file."""
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
    """Describe what a package's folder lacks, definitions or the package's name; empty if nothing."""
    from graphflow.msgs.misplaced import without_kinds  # only errors need it

    return without_kinds(package, _packages.get(package), list(roots()))


def misplaced(package: str, name: str) -> str:
    """Describe the move or renaming of a file that seems to be meant but lies elsewhere; else empty."""
    from graphflow.msgs.misplaced import meant

    return meant(name, [root / package for root in roots()] + ([_packages[package]] if package in _packages else []))


def why_different(name: str) -> str:
    """Advise on a node whose definition differs from the one here."""
    try:
        file = definition_file(name)
    except UnknownInterface:
        return ""
    if file.is_relative_to(BUNDLED):
        return ""
    return f"; if {file} was changed after the node had started, start the node again"


def definition_file(name: str) -> Path:
    """Return the file that defines `package/kind/Name`.

    Raises:
        UnknownInterface: There is no such file; the text names the nearest.
    """
    package, kind, base = name.split("/")
    if kind in KINDS and base.isidentifier():
        for folder in package_folders(package):
            path = folder / kind / f"{base}.{kind}"
            if path.is_file():
                return path
            deeper = next((folder / kind).rglob(path.name), None)  # subfolders are no part of the name
            if deeper is not None:
                return deeper
    raise UnknownInterface(_unknown(package, kind, base, names_in(package, kind)))


@cache
def interface(name: str) -> Interface:
    """Return the schema of `package/kind/Name`.

    Raises:
        UnknownInterface: There is no such definition.
        InterfaceError: Its text is wrong.
    """
    text = definition(name)
    try:
        return idl.parse(name, text)
    except InterfaceError as error:
        place = "" if name in _foreign else f"{definition_file(name)}: "
        raise InterfaceError(f"{place}{error}") from None


@cache
def message_schema(name: str) -> Message:
    """Return the schema of a message, or of one derived from a service or action (`.../srv/Spawn_Request`).

    Raises:
        UnknownInterface, InterfaceError: As for `interface`; also if a nested type is wrong, contains itself, or is
            nested too deep.
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
    """Return the interface whose file defines a type: the service, for `package/srv/Spawn_Request`."""
    package, kind, base = name.split("/")
    return name if kind == "msg" else f"{package}/{kind}/{base.partition('_')[0]}"


def service_schema(name: str) -> Service:
    """Return the schema of a service, or of one of an action's two (`.../action/Fibonacci_SendGoal`)."""
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
    """Return whether a message type has number arrays without a fixed size, as images and clouds have: it may be large.

    Arrays in the elements of lists do not count: they are many and small, as in parameters.
    """
    types = [field.type for field in message_schema(name).fields if field.type.base not in STRINGS]
    return any(
        type_.array in ("unbounded", "bounded")
        if type_.base in NUMERIC
        else not type_.array and has_number_lists(type_.base)
        for type_ in types
    )


def whole_schema(name: str) -> Message:
    """Return the type of `name` for keys and tokens: a message itself, a service or action as a whole.

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
    """Return RIHS01 of a message, or of a service or action as a whole."""
    return type_hash(whole_schema(name), message_schema)


@cache
def interface_class(name: str) -> type:
    """Return the Python class of `package/kind/Name`, or of a derived message, as the wire profile defines it.

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
    """Return the codec of a message."""
    return Codec(message_schema(name), _types_for(name, "numpy"))


@cache
def plain_codec(name: str) -> Codec:
    """Return a codec that decodes numeric arrays into lists: slower for long ones, but without numpy."""
    return Codec(message_schema(name), _types_for(name, "list"))


def _types_for(name: str, style: Style) -> Types:
    """Return the types for the codec of a message: a foreign type, or a response with one, has tighter bounds."""
    owner = _owner(name)
    types = Types(message_schema, interface_class, checked, style)
    return types._replace(values=VALUES_BOUND) if owner in _foreign or owner == DESCRIBING else types


def has_numeric_arrays(name: str) -> bool:
    """Return whether a message type, or a part of a service or action, has number arrays, for which numpy is loaded."""
    whole = whole_schema(name)
    schemas = [whole, *referenced(whole, message_schema).values()]
    return any(field.type.array and field.type.base in FORMATS for schema in schemas for field in schema.fields)


def forget() -> None:
    """Re-read every definition from now on; existing classes stay. For editors and tests."""
    for memory in (interface, _part, message_schema, hash_of, interface_class, codec, plain_codec):
        memory.cache_clear()


def prototype(name: str) -> Any:
    """Create the message that users of an interface fill in: itself, a service's request, or an action's goal."""
    found = interface(name)
    part = found.request if isinstance(found, Service) else found.goal if isinstance(found, Action) else found
    return example(part.name)


def example(name: str) -> Any:
    """Create a message with all fields at their defaults."""
    return interface_class(name)()
