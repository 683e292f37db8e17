"""Everything the command line prints: data to stdout, talk to stderr."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any


def data(text: str) -> None:
    """A line of what was asked for."""
    print(text, flush=True)


def lines(texts: Iterable[str]) -> None:
    """Several lines of what was asked for."""
    for text in texts:
        print(text)
    sys.stdout.flush()


def as_json(value: Any) -> None:
    """What was asked for, for programs."""
    import json

    print(json.dumps(value, default=_plain), flush=True)


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if isinstance(value, bytes) else str(value)


def talk(text: str) -> None:
    """A word to the user: progress, hints, warnings."""
    print(text, file=sys.stderr, flush=True)


def error(text: str) -> None:
    """Why the command failed, and what to do."""
    print(text if text.startswith("error:") else f"error: {text}", file=sys.stderr, flush=True)
