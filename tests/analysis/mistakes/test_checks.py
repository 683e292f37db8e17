"""The tables of checks."""

from __future__ import annotations

import ast
from functools import partial
from pathlib import Path

from graphflow.analysis import mistakes
from graphflow.analysis.mistakes import native_source, rclpy_source
from graphflow.analysis.mistakes.checks import IN_CODE, IN_FILES

PACKAGE = Path(mistakes.__file__).parent


def test_every_module_is_run() -> None:
    """No check is written and then forgotten: each module is imported by a table, or by what runs the tables."""
    sources = [(PACKAGE / name).read_text() for name in ("checks.py", "native_source.py", "rclpy_source.py")]
    imported = {
        found.module for text in sources for found in ast.walk(ast.parse(text)) if isinstance(found, ast.ImportFrom)
    }
    modules = [path.relative_to(PACKAGE).with_suffix("") for path in PACKAGE.glob("*/*.py") if path.stem != "__init__"]
    assert not [m for m in modules if f"{mistakes.__name__}.{'.'.join(m.parts)}" not in imported]


def test_every_check_is_run() -> None:
    """Each check that a table's module imports is in a table."""
    for name in ("checks.py", "native_source.py", "rclpy_source.py"):
        module = ast.parse((PACKAGE / name).read_text())
        imports = [node for node in module.body if isinstance(node, ast.ImportFrom) and node.module != "__future__"]
        used = {node.id for node in ast.walk(module) if isinstance(node, ast.Name)}
        assert {alias.asname or alias.name for node in imports for alias in node.names} <= used


def test_no_check_runs_twice() -> None:
    """A check of both kinds of program is in one table only."""
    for own in (native_source._IN_CLASSES, rclpy_source._IN_PROGRAMS):
        checks = [check.func if isinstance(check, partial) else check for check in (*IN_CODE, *IN_FILES, *own)]
        assert len(checks) == len(set(checks))
