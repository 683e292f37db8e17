"""Changes of the graph file: shown before they are written, and written atomically."""

from __future__ import annotations

import difflib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

from graphflow.errors import GraphFileError, GraphflowError
from graphflow.graph.edit import KeyPath, node_paths
from graphflow.graph.resolve import load
from graphflow.tui.view import ConsoleBase
from graphflow.tui.widgets.dialogs import Ask, Choice

DIFF_LINES = 30


def write_nodes(
    console: ConsoleBase,
    nodes: set[str],
    change: Callable[[str, dict[str, KeyPath]], str],
    what: str,
    written: Callable[[], None],
) -> None:
    """Change nodes in the graph file.

    Args:
        change: Returns the new text, given the place of each node in the file.
        what: A description of the change, for the question.
        written: Called after the file has been written.
    """
    hub = console.hub
    if hub.plan is None or hub.supervision is None:
        console.say("there is no graph file to write to: these nodes were started elsewhere", bad=True)
        return
    try:
        paths = node_paths(hub.plan, nodes, hub.folder)
    except (OSError, GraphflowError) as error:
        console.say(str(error), bad=True)
        return
    unknown = nodes - set(paths)
    if unknown:
        console.say(f"not in the graph file: {', '.join(sorted(unknown))}", bad=True)
        return
    write_file(console, Path(hub.supervision.run.file), lambda text: change(text, paths), what, written)


def write_file(
    console: ConsoleBase,
    file: Path,
    change: Callable[[str], str],
    what: str,
    written: Callable[[], None] = lambda: None,
) -> None:
    """Show the change of a file as a diff, and write it if the user confirms."""
    try:
        before = file.read_text(encoding="utf-8")
        after = change(before)
        _must_load(file, after)
    except (OSError, GraphflowError) as error:
        console.say(f"{file.name}: {error}", bad=True)
        return
    if after == before:
        console.say(f"{file.name} needs no change")
        return
    lines = list(difflib.unified_diff(before.split("\n"), after.split("\n"), file.name, file.name, lineterm="", n=1))
    more = [f"... {len(lines) - DIFF_LINES} lines more"] if len(lines) > DIFF_LINES else []

    def on_answer(key: str | None) -> None:
        if key != "w":
            return
        try:
            _replace(file, after)
        except OSError as error:
            console.say(f"{file.name}: {error.strerror}; nothing was changed", bad=True)
            return
        written()
        console.say(f"written to {file}")
        console.hub.announce(f"wrote {what} to {file.name}")

    question = f"Write {what} to {file.name}?"
    detail = "\n".join([*lines[2 : DIFF_LINES + 2], *more])
    console.push_screen(Ask(question, [Choice("w", "write")], detail), on_answer)


def _must_load(file: Path, text: str) -> None:
    """Check that the new text loads as a graph file, in the same folder, so that its includes are found."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", dir=file.parent, encoding="utf-8") as trial:
        trial.write(text)
        trial.flush()
        try:
            load(Path(trial.name), [])
        except GraphFileError as error:
            # The file is loaded without the arguments of the run; those that it needs are no fault of the change.
            wrong = [p for p in error.problems if "has no default" not in p.message]
            if wrong:
                raise GraphFileError(wrong) from None


def _replace(file: Path, text: str) -> None:
    """Replace a file atomically."""
    handle, name = tempfile.mkstemp(dir=file.parent, prefix=f".{file.name}-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as fresh:
            fresh.write(text)
            fresh.flush()
            # Before the rename: after a power failure the name could otherwise stand for an empty file.
            os.fsync(fresh.fileno())
        # `mkstemp` makes a file that only its owner can read.
        os.chmod(name, file.stat().st_mode & 0o777)
        os.replace(name, file)
    except OSError:
        Path(name).unlink(missing_ok=True)
        raise
