"""`metadata.yaml`, rosbag2's description of a bag, and QoS profiles in its format.

Source: rosbag2_storage, version 9 of its metadata; older ones have numbers in place of names.
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
"""Largest size of the file in bytes."""
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
"""LibYAML's are ten times as fast: a large bag has a large file, which is written again and again."""


class FileContents(NamedTuple):
    """The contents of one file of a bag."""

    name: str
    contents: Contents


def written(files: list[FileContents], whole: Contents, custom: Mapping[str, str], storage: str = "mcap") -> str:
    """Return the text of the file.

    Args:
        custom: The user's own metadata.
    """

    def times(contents: Contents) -> dict[str, object]:
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


def read(folder: Path) -> dict[str, object]:
    """Read the metadata of a bag; empty if there is no file.

    Raises:
        BagError: It cannot be read.
    """
    path = folder / FILE
    try:
        data: Any = loaded(found_bytes(path, BOUND))
        return dict(data["rosbag2_bagfile_information"])
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise BagError(f"{path}: {error.strerror}") from None
    except (yaml.YAMLError, RecursionError, KeyError, TypeError, ValueError) as error:
        first = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise BagError(f"{path}: it is not a bag's metadata: {first}") from None


def plain(qos: Qos) -> dict[str, object]:
    """Convert a profile to rosbag2's format."""

    def span(ns: int) -> dict[str, int]:
        return {"sec": ns // 10**9, "nsec": ns % 10**9}

    return {
        "history": qos.history.name.lower(),
        "depth": qos.depth,
        "reliability": qos.reliability.name.lower(),
        "durability": qos.durability.name.lower(),
        **{key: span(getattr(qos, name)) for key, name in list(DURATIONS.items())[:2]},
        "liveliness": qos.liveliness.name.lower(),
        "liveliness_lease_duration": span(qos.lease_ns),
        "avoid_ros_namespace_conventions": False,
    }


def profiles(value: object) -> tuple[Qos, ...]:
    """Read the profiles of a bag: a list, or the YAML text of one; unreadable ones are left out."""
    if isinstance(value, str):
        try:
            value = loaded(value[:BOUND])
        except (yaml.YAMLError, RecursionError, ValueError):
            return ()
    rows = value if isinstance(value, list) else []
    return tuple(_profile(row) for row in rows[:_MAX_PROFILES] if isinstance(row, Mapping))


def _profile(row: Mapping[str, object]) -> Qos:
    policies: dict[str, Any] = {}
    for key, enum in ENUMS.items():
        value = row.get(key, "")
        policy = str(value).upper() if isinstance(value, (str, int)) else ""
        if policy in enum.__members__ and policy != "BEST_AVAILABLE":
            policies[key] = enum[policy]
        elif (
            policy.isdecimal()
            and len(policy) < 9
            and int(policy) in {m.value for m in enum if m.name != "BEST_AVAILABLE"}
        ):
            policies[key] = enum(int(policy))
    depth = row.get("depth")
    if isinstance(depth, int) and 0 < depth < 2**31:
        policies["depth"] = depth
    for key, name in DURATIONS.items():
        policies[name] = _span(row.get(key))
    return Qos(**policies)


def _span(value: object) -> int:
    if isinstance(value, Mapping):
        sec, nsec = value.get("sec"), value.get("nsec")
        if isinstance(sec, int) and isinstance(nsec, int) and 0 <= sec * 10**9 + nsec < INFINITE_NS:
            return sec * 10**9 + nsec
    return INFINITE_NS


def as_text(offered: Iterable[Qos]) -> str:
    """Format profiles as for the channels of MCAP files."""
    return _dumped([plain(qos) for qos in offered])


def loaded(text: str | bytes) -> object:
    """Parse YAML; aliases are refused, since a few of them can expand beyond any memory."""
    if any(isinstance(event, yaml.AliasEvent) for event in yaml.parse(text, _LOADER)):
        raise ValueError("it has aliases")
    return yaml.load(text, _LOADER)  # noqa: S506 - a safe one


def _dumped(data: object) -> str:
    return yaml.dump(data, Dumper=_DUMPER, sort_keys=False, default_flow_style=False)
