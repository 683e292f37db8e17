"""Policies of one kind given as another: `QoSProfile(depth=10, durability=ReliabilityPolicy.BEST_EFFORT)`.

ROS 2 takes the policy of the same number, VOLATILE here, silently.
"""

from __future__ import annotations

import logging
import sys
from enum import IntEnum

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.errors import Place

_reported: set[tuple[Place, str]] = set()
"""The lines that have been reported, each with a policy."""
_KINDS = {
    "history": "HistoryPolicy",
    "reliability": "ReliabilityPolicy",
    "durability": "DurabilityPolicy",
    "liveliness": "LivelinessPolicy",
}
"""The class of each policy's values."""
logger = logging.getLogger("graphflow")


def check(word: str, value: object, taken: object) -> None:
    """Warn, once per line, of a value that belongs to another policy and means something else as this one.

    Args:
        word: The policy that is set.
        value: The value given for it.
        taken: The value that it is read as.
    """
    own = next((policy for policy, kind in _KINDS.items() if kind == type(value).__name__), word)
    if own == word or not isinstance(value, IntEnum):  # a number, or graphflow's own value
        return
    given = f"{type(value).__name__}.{value.name}"
    read = f"{type(taken).__name__}.{taken.name}" if isinstance(taken, IntEnum) else str(taken)
    frame = users_frame(sys._getframe(1))
    if frame is None or read.endswith(f".{value.name}"):  # SYSTEM_DEFAULT is the same in all
        return
    place = short_place(frame.f_code.co_filename, frame.f_lineno)
    if (place, word) not in _reported:
        _reported.add((place, word))
        text = "%s: %s=%s is read as %s, since only the number counts: write %s=%s"
        logger.warning(text, place, word, given, read, own, given)
