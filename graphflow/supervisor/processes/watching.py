"""`up --watch`: restart nodes when their source has changed."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.errors import SupervisorError
from graphflow.interface import Interface
from graphflow.reading import found_bytes

if TYPE_CHECKING:
    from graphflow.graph.checks.check import Interfaces
    from graphflow.graph.plan import Plan
    from graphflow.supervisor.supervisor import Supervisor

CHECK_EVERY = 0.5
"""Seconds between two checks of the files."""
_SKIPPED = {"__pycache__", ".venv", "venv", ".git", "node_modules"}
MAX_FILES = 2000
"""Largest number of source files that are watched besides those of node classes."""


class Watch:
    """The watch over the Python files of a project.

    A change in a file with a node class restarts the nodes of that file; one in any other file, which all may import,
    restarts all.

    Args:
        root: The project's folder.
        nodes: Nodes by the file that defines their class.
        restart: Restarts a node.
        note: Called with each change, and with the reason if it restarts nothing.
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
            except OSError:  # it is being replaced by an editor
                continue
            found[path] = (stat.st_mtime_ns, stat.st_size)
        return found

    def check(self) -> None:
        """Restart the nodes whose files have changed since the last check."""
        stamps = self._stamps()
        changed = [path for path, stamp in stamps.items() if self._seen.get(path, stamp) != stamp]
        self._seen |= stamps
        names: list[str] = []
        for path in sorted(changed):
            try:
                compile(found_bytes(path), str(path), "exec")
            except SyntaxError as error:
                line = f":{error.lineno}" if error.lineno else ""
                self._note(f"{path}{line}: {error.msg}; nothing was restarted")
                return
            except (ValueError, OSError) as error:
                self._note(f"{path}: {error}; nothing was restarted")
                return
            self._note(f"{path} has changed")
            names += self._nodes.get(path) or [name for group in self._nodes.values() for name in group]
        for name in dict.fromkeys(names):
            try:
                self._restart(name)
            except SupervisorError as error:  # the graph is being stopped, or the node has not been started yet
                self._note(str(error))

    async def run(self) -> None:
        """Check until cancelled."""
        while True:
            await asyncio.sleep(CHECK_EVERY)
            self.check()


async def watch(supervisor: Supervisor, plan: Plan, interfaces: Interfaces) -> None:
    """Restart nodes of a graph when their source changes, once the graph is up."""
    nodes: dict[Path, list[str]] = {}
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if isinstance(interface, Interface):
            nodes.setdefault(Path(interface.place.file).resolve(), []).append(node.name)
    await supervisor.up.wait()
    await Watch(Path(plan.root), nodes, partial(supervisor.restart, by="--watch"), supervisor.note).run()
