"""QoS profiles by topic for recording and playback: `--qos-profile-overrides-path`.

    /turtle1/pose:
      reliability: best_effort
      history: keep_last
      depth: 5
      durability: volatile

Source: ROS 2's guide "Overriding QoS policies for recording and playback".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import yaml

from graphflow.bag.formats.metadata import DURATIONS, ENUMS, loaded
from graphflow.errors import GraphflowError, UsageFault
from graphflow.names import check_full_name, did_you_mean
from graphflow.qos import Qos
from graphflow.reading import found_bytes

BOUND = 1 << 20
"""Largest size of such a file in bytes."""
_ROS_ONLY = "avoid_ros_namespace_conventions"
_KEYS = (*ENUMS, "depth", *DURATIONS, _ROS_ONLY)


def named_file(path: Path, advice: str = "") -> object:
    """Read a YAML file that the user has named.

    Args:
        advice: The end of the message if it cannot be opened.

    Raises:
        UsageFault: It cannot be read, or is not YAML.
    """
    try:
        return loaded(found_bytes(path, BOUND))
    except OSError as error:
        raise UsageFault(f"{path}: {error.strerror}{advice}") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        where = f":{mark.line + 1}:{mark.column + 1}" if mark is not None else ""
        raise UsageFault(f"{path}{where}: not valid YAML: {error.problem or error}") from None
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise UsageFault(f"{path}: {' '.join(str(error).split())[:300]}") from None


def read(path: Path) -> dict[str, Qos]:
    """Read the profiles of a file, by the full names of topics; policies that a profile leaves out are the defaults.

    Raises:
        UsageFault: It cannot be read, or has a mistake, which the text describes with its place.
    """
    data = named_file(path)
    if not isinstance(data, Mapping):
        raise UsageFault(f"{path}: it has no topics; write /topic: {{reliability: best_effort}}")
    found = {}
    for topic, row in data.items():
        try:
            check_full_name(str(topic))
            found[str(topic)] = _profile(row)
        except (GraphflowError, ValueError) as error:
            raise UsageFault(f"{path}: {topic}: {error}") from None
    return found


def _profile(row: object) -> Qos:
    if not isinstance(row, Mapping):
        raise ValueError("a profile has policies, such as reliability: best_effort")
    policies: dict[str, Any] = {}
    for key, value in row.items():
        if key in ENUMS:
            members = ENUMS[key].__members__
            if str(value).upper() not in members:
                raise ValueError(f"{key}: {value!r} is not one of {', '.join(m.lower() for m in members)}")
            policies[key] = members[str(value).upper()]
        elif key == "depth":
            if type(value) is not int or not 0 <= value < 2**31:
                raise ValueError(f"depth: {value!r} is not a number of messages")
            policies[key] = value
        elif key in DURATIONS:
            policies[DURATIONS[key]] = _span(key, value)
        elif key != _ROS_ONLY:
            raise ValueError(f"there is no policy {key!r}{did_you_mean(str(key), _KEYS)}")
    return replace(Qos(), **policies)


def _span(key: str, value: object) -> int:
    if isinstance(value, Mapping) and {*value} <= {"sec", "nsec"}:
        sec, nsec = value.get("sec", 0), value.get("nsec", 0)
        if type(sec) is int and type(nsec) is int and 0 <= sec * 10**9 + nsec < 2**63:
            return sec * 10**9 + nsec
    raise ValueError(f"{key}: {value!r} is not a duration; write {{sec: 1, nsec: 0}}")
