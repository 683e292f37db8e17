"""Descriptions of the bags that `bag convert` writes, in rosbag2's format: `--output-options`.

    output_bags:
      - uri: driving
        storage_id: mcap
        topics: [/cmd_vel]
        storage_preset_profile: zstd_small

Each entry has options of the storage and of recording; without topics and patterns, all topics are chosen.

Source: rosbag2's README, "Converting bags"; StorageOptions and RecordOptions of rosbag2.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from graphflow.bag.overrides import named_file
from graphflow.bag.topic_choice import Choice
from graphflow.errors import GraphflowError, UsageFault
from graphflow.names import did_you_mean, expand

_PACKED = {"none": "none", "fastwrite": "none", "zstd_fast": "zstd", "zstd_small": "zstd", "": "zstd"}
"""Compression of chunks by rosbag2's presets of MCAP."""
_LISTS = {"topics", "topic_types", "services", "exclude_topics", "exclude_topic_types", "exclude_services"}
_LISTS |= {"exclude_service_events"}
_TEXTS = {"uri", "storage_id", "storage_preset_profile", "compression_mode", "compression_format", "regex"}
_TEXTS |= {"exclude_regex", "exclude"}
_FLAGS = {"all", "all_topics", "all_services", "include_hidden_topics"}
_NUMBERS = {"max_bagfile_size", "max_bagfile_duration", "start_time_ns", "end_time_ns"}
_TAKEN = {"max_cache_size", "snapshot_mode", "rmw_serialization_format", "compression_queue_size", "all_actions"}
_TAKEN |= {"compression_threads", "is_discovery_disabled", "topic_polling_interval", "include_unpublished_topics"}
_TAKEN |= {"ignore_leaf_topics", "start_paused", "use_sim_time", "node_prefix", "append"}
"""Options that concern recording alone, or have no effect here."""
_KEYS = _LISTS | _TEXTS | _FLAGS | _NUMBERS | _TAKEN


class Output(NamedTuple):
    """A bag to be written."""

    folder: Path
    choice: Choice
    storage: str
    compression: str | None
    max_size: int
    """Size in bytes after which a new file starts; 0 for none."""
    max_seconds: float
    start_ns: int
    end_ns: int | None
    remarks: list[str]
    """Ignored keys."""


def is_options(path: Path) -> bool:
    """Return whether a path given with `-o` is such a file and not the folder of a new bag."""
    return path.is_file() or (path.suffix in (".yaml", ".yml") and not path.exists())


def read(path: Path) -> list[Output]:
    """Read the bags of a file, at least one.

    Raises:
        UsageFault: It cannot be read, or has a mistake, which the text describes with its place.
    """
    data = named_file(path, "; to make a bag of that name, write it without .yaml")
    rows = data.get("output_bags") if isinstance(data, Mapping) else None
    if not isinstance(rows, list) or not rows:
        raise UsageFault(f"{path}: it names no bags; write output_bags: [{{uri: NAME, storage_id: mcap}}]")
    found = []
    for number, row in enumerate(rows, 1):
        try:
            found.append(_output(row))
        except (GraphflowError, ValueError) as error:
            raise UsageFault(f"{path}: output_bags, entry {number}: {error}") from None
    return found


def _output(row: object) -> Output:
    if not isinstance(row, Mapping):
        raise ValueError("it is not a mapping; write uri: NAME")
    for key, value in row.items():
        if key in _TEXTS and type(value) is not str:
            raise ValueError(f"{key}: {value!r} is not a text")
        if key in _FLAGS and type(value) is not bool:
            raise ValueError(f"{key}: {value!r} is not true or false")
        if key in _NUMBERS and (type(value) is not int or value < 0):
            raise ValueError(f"{key}: {value!r} is not a non-negative integer")
    if not row.get("uri"):
        raise ValueError("it has no uri, the folder of the new bag")
    storage = row.get("storage_id") or "mcap"
    if storage not in ("mcap", "sqlite3"):
        raise ValueError(f"storage_id: bags are written as mcap or sqlite3, not as {storage!r}")
    return Output(
        folder=Path(row["uri"]),
        choice=_choice(row),
        storage=storage,
        compression=_compression(row) if storage == "mcap" else None,
        max_size=row.get("max_bagfile_size", 0),
        max_seconds=float(row.get("max_bagfile_duration", 0)),
        start_ns=row.get("start_time_ns", 0),
        end_ns=row["end_time_ns"] + 1 if row.get("end_time_ns") else None,  # ours is exclusive
        remarks=[f"{key} has no effect{did_you_mean(str(key), sorted(_KEYS))}" for key in row if key not in _KEYS],
    )


def _choice(row: Mapping[str, Any]) -> Choice:
    topics, services = _names(row, "topics"), _names(row, "services")
    types, regex = _texts(row, "topic_types"), row.get("regex", "")
    is_open = not (topics or services or types or regex)
    everything = row.get("all", False)
    return Choice(
        all=everything or row.get("all_topics", is_open and not row.get("all_services", False)),
        topics=topics,
        types=types,
        regex=regex,
        services=services,
        all_services=everything or row.get("all_services", is_open),
        exclude=_names(row, "exclude_topics"),
        exclude_types=_texts(row, "exclude_topic_types"),
        exclude_regex=row.get("exclude_regex") or row.get("exclude", ""),
        exclude_services=_names(row, "exclude_services") | _names(row, "exclude_service_events"),
        hidden=row.get("include_hidden_topics", True),
    )


def _texts(row: Mapping[str, object], key: str) -> frozenset[str]:
    value = row.get(key) or []
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise ValueError(f"{key}: {value!r} is not a list of names")
    return frozenset(value)


def _names(row: Mapping[str, object], key: str) -> frozenset[str]:
    return frozenset(expand(name, "/", "cli") for name in _texts(row, key))


def _compression(row: Mapping[str, Any]) -> str:
    mode, preset = row.get("compression_mode", "").lower(), row.get("storage_preset_profile", "")
    if mode in ("file", "message"):  # MCAP has only the compression of chunks
        name = row.get("compression_format") or "zstd"
        if name not in ("zstd", "lz4"):
            raise ValueError(f"compression_format: {name!r} is not available; write zstd or lz4")
        return str(name)
    if mode not in ("", "none"):
        raise ValueError(f"compression_mode: {mode!r} is not one of none, file, message")
    if preset not in _PACKED:
        raise ValueError(f"storage_preset_profile: {preset!r} is not one of {', '.join(filter(None, _PACKED))}")
    return _PACKED[preset]
