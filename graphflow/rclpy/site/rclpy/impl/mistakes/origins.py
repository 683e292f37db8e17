"""The lines of user code that create the entities of nodes."""

from __future__ import annotations

from types import CodeType
from typing import NamedTuple

from graphflow.errors import Place


class Origin(NamedTuple):
    """The creation of an entity."""

    place: Place
    code: CodeType
    """The function that created it."""
    name: object
    """The name by which entities count as equal: that of the topic or service, or a timer's callback."""


class Created:
    """An entity that user code may have created."""

    made_at: Origin | None = None
    """None for graphflow's own entities."""
