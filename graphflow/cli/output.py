"""Everything the command line prints: data to stdout, talk to stderr.

Names, messages and errors may come from other processes: nothing that a terminal would obey gets through.
"""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Iterable, Sequence
from typing import Any

from graphflow.errors import harmless, uncoloured


def is_terminal() -> bool:
    """Whether there is a terminal on which a console can be opened; a browser that Textual serves counts as one."""
    if "web_driver" in os.environ.get("TEXTUAL_DRIVER", ""):
        return True
    return sys.stdin.isatty() and sys.stdout.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


class Closed(io.TextIOWrapper):
    """Takes the place of a standard output that was closed at the start: nodes may print, and nobody reads it."""


def _write(text: str, *, flush: bool = True) -> None:
    """Write to standard output.

    Raises:
        OSError: There is none.
    """
    if isinstance(sys.stdout, Closed):
        raise OSError(errno.EBADF, "standard output is closed; to throw away what is printed: > /dev/null")
    print(text, end="", flush=flush)


def data(text: str) -> None:
    """A line of what was asked for."""
    _write(f"{harmless(text)}\n")


def lines(texts: Iterable[str]) -> None:
    """Several lines of what was asked for."""
    for text in texts:
        _write(f"{harmless(text)}\n", flush=False)
    sys.stdout.flush()


def listing(names: Iterable[str], *, json: bool) -> None:
    """Names that were asked for: one a line, or as a list for programs."""
    if json:
        as_json(list(names))
    else:
        lines(names)


def colored(head: str, colour: int, texts: Iterable[str]) -> None:
    """Several lines, each with a head in a colour of the terminal, from 31 to 36."""
    for text in texts:
        _write(f"\x1b[{colour}m{harmless(head)}\x1b[0m{uncoloured(text)}\n", flush=False)
    sys.stdout.flush()


def svg(rows: Iterable[Sequence[tuple[str, str]]], title: str) -> str:
    """Rows of a terminal as a picture.

    Args:
        rows: Texts with their styles, in Rich's words.
    """
    from rich.console import Console
    from rich.text import Text

    lines = [Text.assemble(*row) for row in rows]
    width = max(line.cell_len for line in lines)
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        console = Console(record=True, width=width, file=nowhere)
        for line in lines:
            console.print(line, no_wrap=True, crop=False)
        return console.export_svg(title=title)


def progress(text: str) -> None:
    """A line of how it goes, in place of the last one; only on a terminal, and empty to take it away."""
    if sys.stderr.isatty():
        print(f"\r\x1b[2K{harmless(text)}", end="", file=sys.stderr, flush=True)


def clear() -> None:
    """Empty the terminal, if there is one."""
    if sys.stdout.isatty():
        print("\x1b[2J\x1b[H", end="")


def screen(text: str) -> None:
    """Lines in place of all that the terminal showed; the caller answers for their escape sequences."""
    print("\x1b[H" + "".join(f"{line}\x1b[K\n" for line in text.splitlines()) + "\x1b[J", end="", flush=True)


def columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows as lines, each column as wide as it must be."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def as_json(value: Any) -> None:
    """What was asked for, for programs."""
    import json

    _write(f"{json.dumps(value, default=_plain)}\n")


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return list(value) if isinstance(value, bytes) else str(value)


def talk(text: str) -> None:
    """A word to the user: progress, hints, warnings."""
    print(harmless(text), file=sys.stderr, flush=True)


def error(text: str) -> None:
    """Why the command failed, and what to do."""
    talk(text if text.startswith("error:") else f"error: {text}")
