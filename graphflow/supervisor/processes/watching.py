"""`up --watch`: nodes are started again when their source has changed."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from pathlib import Path

from graphflow.errors import SupervisorError
from graphflow.reading import found_bytes

LOOK_EVERY = 0.5
"""Seconds between two looks at the files."""
_SKIPPED = {"__pycache__", ".venv", "venv", ".git", "node_modules"}
MAX_FILES = 2000
"""Source files of a project that are looked at."""


class Watch:
    """Looks at the Python files of a project.

    A change in a file with a node class concerns the nodes of that file; one in any other file of the project, which
    they may import, concerns all.

    Args:
        root: The project's folder.
        nodes: Nodes by the file that has their class.
        restart: Starts a node again.
        note: Called with what is done, and why something is not.
    """

    def __init__(
        self,
        root: Path,
        nodes: Mapping[Path, list[str]],
        restart: Callable[[str], None],
        note: Callable[[str], None],
    ) -> None:
        self._root, self._nodes, self._restart, self._note = root, nodes, restart, note
        self._seen = self._stamps()

    def _stamps(self) -> dict[Path, tuple[int, int]]:
        found: dict[Path, tuple[int, int]] = {}
        files = [path for path in self._root.rglob("*.py") if not _SKIPPED & {*path.relative_to(self._root).parts}]
        for path in {*files[:MAX_FILES], *self._nodes}:
            try:
                stat = path.stat()
            except OSError:  # it is being written anew
                continue
            found[path] = (stat.st_mtime_ns, stat.st_size)
        return found

    def look(self) -> None:
        """Start again what has changed since the last look."""
        stamps = self._stamps()
        changed = [path for path, stamp in stamps.items() if self._seen.get(path, stamp) != stamp]
        self._seen |= stamps
        names: list[str] = []
        for path in sorted(changed):
            try:
                compile(found_bytes(path), str(path), "exec")
            except (SyntaxError, ValueError, OSError) as error:
                line = getattr(error, "lineno", None)
                self._note(f"{path}{f':{line}' if line else ''}: {getattr(error, 'msg', error)}; nothing was restarted")
                return
            self._note(f"{path} has changed")
            names += self._nodes.get(path) or [name for group in self._nodes.values() for name in group]
        for name in dict.fromkeys(names):
            try:
                self._restart(name)
            except SupervisorError as error:  # the graph is being stopped, or the node has not begun yet
                self._note(str(error))

    async def run(self) -> None:
        """Look for as long as the graph runs."""
        while True:
            await asyncio.sleep(LOOK_EVERY)
            self.look()
