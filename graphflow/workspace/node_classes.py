"""Node classes of a file, found in its source and in the modules of its project that it imports."""

from __future__ import annotations

import ast
import builtins
from dataclasses import dataclass, field
from pathlib import Path

from graphflow.reading import found_text
from graphflow.workspace.project import module_of
from graphflow.workspace.source_kinds import uses_ros


def node_classes_in(file: Path) -> dict[str, int]:
    """Return the classes of a file that derive from `Node`, perhaps by others of the project, with their lines."""
    return _Reader(module_of(file)[0]).classes(file)


def sole_class_in(file: Path) -> str | None:
    """Return the only node class of a file from which no other of it derives; None if there is not exactly one."""
    reader = _Reader(module_of(file)[0])
    found = reader.classes(file)
    source = reader.read(file)
    parents = {ast.unparse(base) for name in found for base in source.classes[name].bases}
    leaves = [name for name in found if name not in parents]
    return leaves[0] if len(leaves) == 1 else None


@dataclass
class _Source:
    """The classes and imports of a module."""

    classes: dict[str, ast.ClassDef] = field(default_factory=dict)
    imports: dict[str, tuple[Path, str]] = field(default_factory=dict)
    """Imported names: the path of the module without its suffix, and the name in it, empty for the module itself."""


class _Reader:
    """A reader of modules below a folder, which follows base classes from one to another."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._read: dict[Path, _Source] = {}

    def classes(self, file: Path) -> dict[str, int]:
        """Return the node classes of a file, with their lines."""
        found = self.read(file).classes
        return {name: d.lineno for name, d in found.items() if self._is_node(file, name, frozenset())}

    def read(self, file: Path) -> _Source:
        """Return the classes and imports of a file; empty if it cannot be read."""
        known = self._read.get(file)
        if known is None:
            known = self._read[file] = _Source()
            for item in _body_of(file):
                if isinstance(item, ast.ClassDef):
                    known.classes[item.name] = item
                elif isinstance(item, (ast.Import, ast.ImportFrom)):
                    known.imports.update(self._imported(item, file))
        return known

    def _imported(self, item: ast.Import | ast.ImportFrom, file: Path) -> dict[str, tuple[Path, str]]:
        if isinstance(item, ast.Import):
            return {a.asname or a.name: (self._root.joinpath(*a.name.split(".")), "") for a in item.names}
        folder = (
            self._root if not item.level else file.resolve().parents[min(item.level, len(file.resolve().parents)) - 1]
        )
        module = folder.joinpath(*(item.module or "").split("."))
        return {a.asname or a.name: (module, a.name) for a in item.names}

    def _is_node(self, file: Path, name: str, seen: frozenset[tuple[Path, str]]) -> bool | None:
        """Return whether a class of a file is a node; None if the source does not show it."""
        if (file, name) in seen:
            return None
        source = self.read(file)
        definition = source.classes.get(name)
        if definition is None:
            return self._of_base(file, name, seen | {(file, name)}) if name in source.imports else None
        bases = [self._of_base(file, _written(base), seen | {(file, name)}) for base in definition.bases]
        return True if True in bases else None if None in bases else False

    def _of_base(self, file: Path, name: str, seen: frozenset[tuple[Path, str]]) -> bool | None:
        """Return whether a name in a file, perhaps dotted, refers to a node class; None if that is unknown."""
        found: bool | None = None
        source = self.read(file)
        owner, _, last = name.rpartition(".")
        if not owner and name in source.classes:
            found = self._is_node(file, name, seen)
        elif not owner and name in source.imports:
            module, there = source.imports[name]
            found = self._elsewhere(module, there, seen)
        elif owner in source.imports:
            module, there = source.imports[owner]
            found = self._elsewhere(module / there, last, seen)
        elif hasattr(builtins, name):
            found = False
        return True if found is None and name.endswith("Node") else found

    def _elsewhere(self, module: Path, name: str, seen: frozenset[tuple[Path, str]]) -> bool | None:
        file = next((f for f in (module.with_name(f"{module.name}.py"), module / "__init__.py") if f.is_file()), None)
        if file is None or not name:
            return None
        return False if uses_ros(file) else self._is_node(file, name, seen)  # nodes of rclpy are none of graphflow's


def _written(base: ast.expr) -> str:
    """Return the name of a base class, without type arguments."""
    return ast.unparse(base.value if isinstance(base, ast.Subscript) else base)


def _body_of(file: Path) -> list[ast.stmt]:
    try:
        return ast.parse(found_text(file)).body
    except (OSError, SyntaxError, ValueError):
        return []
