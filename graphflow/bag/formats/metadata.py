"""`metadata.yaml`, in which rosbag2 says what is in a bag, and QoS profiles as it writes them.

Source: rosbag2_storage, version 9 of its metadata; older ones have numbers in place of words.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from enum import IntEnum
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from graphflow.bag.contents import Contents
from graphflow.errors import BagError
from graphflow.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability
from graphflow.reading import found_bytes
from graphflow.wire.profile import wire_profile

FILE = "metadata.yaml"
VERSION = 9
BOUND = 10_000_000
"""Bytes that the file may have."""
ENUMS: dict[str, type[IntEnum]] = {
    "history": History,
    "reliability": Reliability,
    "durability": Durability,
    "liveliness": Liveliness,
}
DURATIONS = {"deadline": "deadline_ns", "lifespan": "lifespan_ns", "liveliness_lease_duration": "lease_ns"}
_MAX_PROFILES = 100
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
"""Those of LibYAML are ten times as fast: a large bag has a large file, which is written again and again."""


class FileContents(NamedTuple):
    """One file of a bag."""

    name: str
    contents: Contents


def written(files: list[FileContents], whole: Contents, custom: Mapping[str, str], storage: str = "mcap") -> str:
    """The text of the file.

    Args:
        custom: What the user has to say about the bag.
    """

    def times(contents: Contents) -> dict[str, Any]:
        return {
            "duration": {"nanoseconds": contents.end_ns - contents.start_ns},
            "starting_time": {"nanoseconds_since_epoch": contents.start_ns},
            "message_count": contents.message_count,
        }

    topics = [
        {
            "topic_metadata": {
                "name": topic.name,
                "type": topic.type,
                "serialization_format": topic.encoding,
                "offered_qos_profiles": [plain(qos) for qos in topic.qos],
                "type_description_hash": topic.hash,
            },
            "message_count": whole.counts.get(name, 0),
        }
        for name, topic in whole.topics.items()
    ]
    information = {
        "version": VERSION,
        "storage_identifier": storage,
        **times(whole),
        "topics_with_message_count": topics,
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [file.name for file in files],
        "files": [{"path": file.name, **times(file.contents)} for file in files],
        "custom_data": dict(custom),
        "ros_distro": wire_profile(),
    }
    return _dumped({"rosbag2_bagfile_information": information})


def read(folder: Path) -> dict[str, Any]:
    """What the file says; empty without one.

    Raises:
        BagError: It cannot be read.
    """
    path = folder / FILE
    try:
        data = loaded(found_bytes(path, BOUND))
        return dict(data["rosbag2_bagfile_information"])
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise BagError(f"{path}: {error.strerror}") from None
    except (yaml.YAMLError, RecursionError, KeyError, TypeError, ValueError) as error:
        first = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BagError(f"{path}: it is no bag's metadata: {first}") from None


def plain(qos: Qos) -> dict[str, Any]:
    """A profile as rosbag2 writes it."""

    def span(ns: int) -> dict[str, int]:
        return {"sec": ns // 10**9, "nsec": ns % 10**9}

    return {
        "history": qos.history.name.lower(),
        "depth": qos.depth,
        "reliability": qos.reliability.name.lower(),
        "durability": qos.durability.name.lower(),
        **{word: span(getattr(qos, name)) for word, name in list(DURATIONS.items())[:2]},
        "liveliness": qos.liveliness.name.lower(),
        "liveliness_lease_duration": span(qos.lease_ns),
        "avoid_ros_namespace_conventions": False,
    }


def profiles(said: object) -> tuple[Qos, ...]:
    """Profiles as a bag has them: as a list, or as the text of one; what cannot be read is left out."""
    if isinstance(said, str):
        try:
            said = loaded(said[:BOUND])
        except (yaml.YAMLError, RecursionError, ValueError):
            return ()
    rows = said if isinstance(said, list) else []
    return tuple(_profile(row) for row in rows[:_MAX_PROFILES] if isinstance(row, Mapping))


def _profile(row: Mapping[Any, Any]) -> Qos:
    given: dict[str, Any] = {}
    for key, enum in ENUMS.items():
        said = row.get(key, "")
        word = str(said).upper() if isinstance(said, (str, int)) else ""
        if word in enum.__members__ and word != "BEST_AVAILABLE":
            given[key] = enum[word]
        elif word.isdecimal() and len(word) < 9 and int(word) in {m.value for m in enum if m.name != "BEST_AVAILABLE"}:
            given[key] = enum(int(word))
    depth = row.get("depth")
    if isinstance(depth, int) and 0 < depth < 2**31:
        given["depth"] = depth
    for key, name in DURATIONS.items():
        given[name] = _span(row.get(key))
    return Qos(**given)


def _span(said: object) -> int:
    if isinstance(said, Mapping):
        sec, nsec = said.get("sec"), said.get("nsec")
        if isinstance(sec, int) and isinstance(nsec, int) and 0 <= sec * 10**9 + nsec < INFINITE_NS:
            return sec * 10**9 + nsec
    return INFINITE_NS


def as_text(offered: Iterable[Qos]) -> str:
    """Profiles as MCAP files have them in their channels."""
    return _dumped([plain(qos) for qos in offered])


def loaded(text: str | bytes) -> Any:
    """What a text of YAML says; one with aliases is refused: a few of them can stand for more than any memory holds."""
    if any(isinstance(event, yaml.AliasEvent) for event in yaml.parse(text, _LOADER)):
        raise ValueError("it has aliases")
    return yaml.load(text, _LOADER)  # noqa: S506 - a safe one


def _dumped(data: object) -> str:
    return yaml.dump(data, Dumper=_DUMPER, sort_keys=False, default_flow_style=False)
