"""All printing of the command line: data to stdout, messages to the user to stderr.

Names, messages and errors may come from other processes, so control characters are made harmless.
"""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Iterable, Sequence

from graphflow.errors import harmless, uncoloured


def is_terminal() -> bool:
    """Whether the console can be opened here: on a terminal, or in a browser that Textual serves."""
    if "web_driver" in os.environ.get("TEXTUAL_DRIVER", ""):
        return True
    return sys.stdin.isatty() and sys.stdout.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


class Closed(io.TextIOWrapper):
    """Replacement of a standard output that was closed at the start: nodes may still print, to the null device."""


def _write(text: str, *, flush: bool = True) -> None:
    """Write to standard output.

    Raises:
        OSError: It was closed at the start.
    """
    if isinstance(sys.stdout, Closed):
        raise OSError(errno.EBADF, "standard output is closed; to discard the output: > /dev/null")
    print(text, end="", flush=flush)


def data(text: str) -> None:
    """Print one line of a command's result."""
    _write(f"{harmless(text)}\n")


def lines(texts: Iterable[str]) -> None:
    """Print several lines of a command's result."""
    for text in texts:
        _write(f"{harmless(text)}\n", flush=False)
    sys.stdout.flush()


def listing(names: Iterable[str], *, json: bool) -> None:
    """Print names, one per line or as a JSON list."""
    if json:
        as_json(list(names))
    else:
        lines(names)


def colored(head: str, colour: int, texts: Iterable[str]) -> None:
    """Print lines that each begin with a coloured head; `colour` is an SGR code from 31 to 36."""
    for text in texts:
        _write(f"\x1b[{colour}m{harmless(head)}\x1b[0m{uncoloured(text)}\n", flush=False)
    sys.stdout.flush()


def svg(rows: Iterable[Sequence[tuple[str, str]]], title: str) -> str:
    """Draw the rows of a terminal as an SVG picture.

    Args:
        rows: Texts with their styles, as Rich names them.
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
    """Show progress in place of the last progress line, if stderr is a terminal; an empty text removes it."""
    if sys.stderr.isatty():
        print(f"\r\x1b[2K{harmless(text)}", end="", file=sys.stderr, flush=True)


def clear() -> None:
    """Clear the terminal, if there is one."""
    if sys.stdout.isatty():
        print("\x1b[2J\x1b[H", end="")


def screen(text: str) -> None:
    """Replace the terminal's contents; the caller is responsible for escape sequences in `text`."""
    # Overwritten and not cleared first, which would flicker.
    print("\x1b[H" + "".join(f"{line}\x1b[K\n" for line in text.splitlines()) + "\x1b[J", end="", flush=True)


def columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Align rows of cells as lines of text."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def as_json(value: object) -> None:
    """Print a command's result as one line of JSON."""
    import json

    _write(f"{json.dumps(value, default=_plain)}\n")


def _plain(value: object) -> object:
    if hasattr(value, "tolist"):  # NumPy's arrays and scalars, without importing NumPy for every command
        return value.tolist()
    return list(value) if isinstance(value, bytes) else str(value)


def talk(text: str) -> None:
    """Print a message to the user: progress, a hint or a warning."""
    print(harmless(text), file=sys.stderr, flush=True)


def error(text: str) -> None:
    """Print why the command failed and what to do about it."""
    talk(text if text.startswith("error:") else f"error: {text}")
