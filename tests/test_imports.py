"""What short commands leave unimported, so that they answer at once."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from tests.cases import slow

HEAVY = ("asyncio", "numpy", "pydantic", "textual")


def imported(code: str) -> list[str]:
    """The heavy packages that a fresh interpreter has imported after running `code`."""
    script = f"""
import json, sys
try:
    {code}
except SystemExit as end:
    assert not end.code, end.code
print(json.dumps([name for name in {HEAVY!r} if name in sys.modules]), file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    found: list[str] = json.loads(done.stderr.splitlines()[-1])
    return found


@slow
@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_imports_nothing_heavy(option: str) -> None:
    """`graphflow --help` and `--version` do without everything that takes long to import."""
    assert imported(f"import graphflow.cli.main; graphflow.cli.main.main([{option!r}])") == []


@slow
@pytest.mark.parametrize("verb", ["topic", "node", "service", "param", "interface"])
def test_help_of_a_verb_imports_nothing_heavy(verb: str) -> None:
    """The help of a verb that only looks at a graph does without it, too."""
    assert imported(f"import graphflow.cli.main; graphflow.cli.main.main([{verb!r}, '--help'])") == []


@slow
@pytest.mark.parametrize(
    "module",
    [*(f"graphflow.cli.ros.{verb}" for verb in ("topic", "node", "service")), "graphflow.introspect.graph_view"],
)
def test_the_modules_of_the_list_verbs_import_nothing_heavy(module: str) -> None:
    """Listing nodes, topics and services needs neither asyncio nor numpy, pydantic or textual."""
    assert imported(f"import {module}") == []


def test_up_imports_nothing_heavy_before_the_fork() -> None:
    """The processes of a graph share what `up` had before it forked: nothing with threads, nothing that is slow."""
    assert imported("import graphflow.cli.graphs.graphs, graphflow.supervisor.launching.launch") == []


def test_the_package_itself_imports_nothing_heavy() -> None:
    """`import graphflow` is free until a name of it is used."""
    assert imported("import graphflow; graphflow.__version__") == []


def test_a_heavy_import_is_seen() -> None:
    """The check sees what it looks for."""
    assert imported("import asyncio") == ["asyncio"]
