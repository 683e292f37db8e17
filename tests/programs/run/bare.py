"""A node whose constructor forgets its base class."""

from __future__ import annotations

from typing import Any

from graphflow import Node


class Bare(Node):
    def __init__(self, name: str | None = None, **options: Any) -> None:
        pass
