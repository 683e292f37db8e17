"""A node whose constructor raises."""

from __future__ import annotations

from typing import Any

from graphflow import Node


class NoCamera(Node):
    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        raise LookupError("no such camera")
