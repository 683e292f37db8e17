"""The reader of ROS 1's `.bag` files: messages are converted to CDR, of the corresponding ROS 2 types.

A type that is known here is used as it is known, with the fields of the same names; any other one as the bag defines
it, with names that ROS 2 allows.

Source: the ROS 1 bag format 2.0. Only this module knows `rosbags`, which comes with the extra `ros1`.
"""

from __future__ import annotations

import bz2
import re
import struct
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graphflow.bag.contents import Contents, Record, Topic
from graphflow.bag.formats import compression
from graphflow.bag.formats.definitions import joined, known, parted
from graphflow.errors import BagError, InterfaceError
from graphflow.introspect.installation import requirement
from graphflow.msgs import registry
from graphflow.qos import Durability, Qos

if TYPE_CHECKING:
    from rosbags.interfaces import Connection
    from rosbags.rosbag1 import Reader

MAGIC = b"#ROSBAG V"
CHUNK_BOUND = 1 << 30
"""Largest size of a decompressed chunk in bytes."""
LATCHED = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
_NO_INDEX = "it has no whole index, as when its recording did not end; ROS 1 writes one: rosbag reindex"
_TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_RENAMED = {"tf/msg/tfMessage": "tf2_msgs/msg/TFMessage"}
_CONSTANT = re.compile(r"[A-Z](?:_?[A-Z0-9])*\Z")
_TYPE = re.compile(r"[A-Za-z]\w*/msg/[A-Za-z]\w*\Z", re.ASCII)
_FIELD = re.compile(r"[A-Za-z]\w*\Z", re.ASCII)


class Ros1File:
    """One file.

    Raises:
        BagError: There is no such file, it is not a bag, or `rosbags` is not installed.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._topics: dict[int, Topic] = {}
        self._converters: dict[str, Callable[[bytes], bytes]] = {}
        """Converters by type in the bag."""
        with self._opened() as reader:
            counts, converted = dict[str, int](), dict[str, tuple[str, str, str]]()
            for connection in reader.connections:
                if connection.msgtype not in converted:
                    converted[connection.msgtype] = self._convert(connection)
                name = f"/{connection.topic.lstrip('/')}"
                latched = getattr(connection.ext, "latching", 0)
                self._topics[connection.id] = Topic(
                    name, *converted[connection.msgtype], (LATCHED,) if latched else (Qos(),)
                )
                counts[name] = counts.get(name, 0) + connection.msgcount
            topics = {topic.name: topic for topic in self._topics.values()}
            # The end that rosbags gives is the first nanosecond after the last message.
            start, end = (reader.start_time, reader.end_time - 1) if any(counts.values()) else (0, 0)
        self.contents = Contents(topics, counts, start, end)

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Yield messages in the order of their times. Arguments and errors as for `McapFile.records`."""
        with self._opened() as reader:
            wanted = [c for c in reader.connections if names is None or self._topics[c.id].name in names]
            for connection, when, data in reader.messages(wanted, start_ns, end_ns) if wanted else ():
                message = self._converters[connection.msgtype](data)
                yield Record(self._topics[connection.id], when, when, 0, message)

    @contextmanager
    def _opened(self) -> Iterator[Reader]:
        try:
            from rosbags.rosbag1 import Reader, ReaderError
            from rosbags.serde import SerdeError
        except ModuleNotFoundError:
            text = f"ROS 1 bags need the extra `ros1`: pip install {requirement('ros1')}"
            raise BagError(f"{self.path}: {text}") from None
        try:
            with Reader(self.path) as reader:
                # By itself, rosbags would decompress a chunk to any size.
                for place, chunk in reader.chunks.items():
                    reader.chunks[place] = chunk._replace(decompressor=_bounded(chunk.decompressor))
                yield reader
        except ReaderError as error:
            why = f"{_NO_INDEX} {self.path.name}" if "index" in str(error).lower() else _why(error)
            raise BagError(f"{self.path}: {why}") from None
        except (SerdeError, AssertionError, LookupError, TypeError, ValueError, struct.error) as error:
            raise BagError(f"{self.path}: {_why(error)}") from None
        except (compression.Damaged, EOFError, MemoryError, RecursionError, OverflowError) as error:
            raise BagError(f"{self.path}: it is damaged: {_why(error)}") from None
        except OSError as error:
            raise BagError(f"{self.path}: {error.strerror or 'it is damaged'}") from None

    def _convert(self, connection: Connection) -> tuple[str, str, str]:
        """Prepare a type of the bag; returns its name, hash and definition here."""
        from rosbags.convert.converter import is_same_wireformat, migrate_bytes
        from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

        here, there = get_typestore(Stores.EMPTY), get_typestore(Stores.EMPTY)
        name = _name(connection.msgtype)
        try:
            types = get_types_from_msg(connection.msgdef.data, connection.msgtype)
            _check_names(types)
            there.register(types)
            sources = _sources(types, name)
            definition = joined(name, sources)
            here.register(get_types_from_msg(definition, name))
            is_same = is_same_wireformat(there, here, connection.msgtype, name)
        except (TypesysError, InterfaceError, SyntaxError) as error:
            what = f"the definition of {connection.msgtype[:100]!r}"
            raise BagError(f"{self.path}: {what} cannot be used: {' '.join(str(error).split())[:200]}") from None
        if is_same:
            self._converters[connection.msgtype] = lambda data: bytes(here.ros1_to_cdr(data, name))
        else:
            migrate = partial(migrate_bytes, there, here, connection.msgtype, name, {}, src_is2=False, dst_is2=True)
            self._converters[connection.msgtype] = lambda data: bytes(migrate(data))
        return name, registry.hash_of(name) if _is_known(name) else "", definition


def _check_names(types: Mapping[str, Any]) -> None:
    """Check the names of types and fields in a bag: rosbags generates and executes a Python module with them.

    Raises:
        InterfaceError: A name is not legal.
    """
    for one, (constants, fields) in types.items():
        if not _TYPE.match(one):
            raise InterfaceError(f"{one[:100]!r} is not a legal type name")
        for name in (*(constant[0] for constant in constants), *(field for field, _ in fields)):
            if not _FIELD.match(name):
                raise InterfaceError(f"{name[:100]!r} is not a legal field name")


def _sources(types: Mapping[str, Any], name: str) -> dict[str, str]:
    """Return the definitions of a type and of its nested types, by their names here."""
    found: dict[str, str] = {}
    for one, (constants, fields) in types.items():
        new = _name(one)
        if _is_known(new):
            found.update(parted(new, known(new)))
            continue
        for time in _TIMES:
            found.update(parted(time, known(time)))
        lines = [_constant(*constant) for constant in constants if _CONSTANT.match(constant[0])]
        names = [_field_name(field) for field, _ in fields]
        if len({*names}) != len(names):
            names = [f"{field.rstrip('_')}{number}" for number, field in enumerate(names)]
        lines += [f"{_type(desc)} {field}\n" for field, (_, desc) in zip(names, fields, strict=True)]
        found[new] = "".join(lines)
    return {name: found.pop(name), **found}


def _is_known(name: str) -> bool:
    try:
        registry.definition_file(name)
    except InterfaceError:
        return False
    return True


def _name(there: str) -> str:
    """Convert the name of a type in a bag to its name here."""
    package, _, short = _RENAMED.get(there, there).rpartition("/")
    return f"{package}/{short[:1].upper()}{short[1:].replace('_', '')}"


def _field_name(there: str) -> str:
    """Convert a field's name to lower case with single underscores."""
    parts = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", there).lower().split("_")
    return "_".join(part for part in parts if part)


def _type(desc: Any) -> str:
    """Format the type of a field as definitions do."""
    from rosbags.interfaces import Nodetype

    kind, about = desc
    if kind == Nodetype.BASE:
        return str(about[0])
    if kind == Nodetype.NAME:
        return _name(about).replace("/msg/", "/")
    inner, size = about
    return f"{_type(inner)}[{size or ''}]"


def _constant(name: str, type_: str, value: object) -> str:
    text = '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"' if type_ == "string" else str(value)
    return f"{type_} {name}={text}\n"


def _bounded(decompressor: Callable[[bytes], bytes]) -> Callable[[bytes], bytes]:
    """Bound the result of a decompressor of rosbags."""
    from lz4.frame import decompress as of_lz4

    if decompressor is bz2.decompress:
        return _of_bz2
    if decompressor is of_lz4:
        return _of_lz4
    return decompressor


def _of_bz2(data: bytes) -> bytes:
    return _checked(bz2.BZ2Decompressor().decompress(data, CHUNK_BOUND + 1))


def _of_lz4(data: bytes) -> bytes:
    return _checked(compression.unpacked("lz4", data, CHUNK_BOUND))


def _checked(data: bytes) -> bytes:
    if len(data) > CHUNK_BOUND:
        raise compression.Damaged(f"a chunk has more than {CHUNK_BOUND:,} bytes")
    return data


def _why(error: Exception) -> str:
    return str(error) or "it is damaged"
