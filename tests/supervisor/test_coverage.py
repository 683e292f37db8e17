"""Coverage of nodes that run in processes of their own, with the settings that the page on testing has."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import LIMIT, PROJECT, Machine

pytest.importorskip("coverage")
pytestmark = pytest.mark.real

NODE = """
from graphflow import Node, timer


class Counter(Node):
    @timer(hz=50.0)
    async def count(self) -> None:
        self.log.info("counted")


def never() -> int:
    return 1
"""


@slow
def test_forked_nodes_are_measured(machine: Machine, tmp_path: Path) -> None:
    """The lines of a handler count, though nothing but the node's process has run them."""
    page = (PROJECT / "docs" / "testing.md").read_text(encoding="utf-8")
    settings = re.search(r"```text\n(\[run\]\n.*?)```", page, re.DOTALL)
    assert settings is not None
    (tmp_path / ".coveragerc").write_text(settings[1])
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "counter.py").write_text(NODE)
    (tmp_path / "lab.yaml").write_text("nodes: {/counter: {class: 'nodes.counter:Counter'}}")

    def coverage(*words: str) -> subprocess.Popen[str]:
        command = [sys.executable, "-m", "coverage", *words]
        return subprocess.Popen(command, cwd=tmp_path, env=machine.env, stdout=subprocess.PIPE, text=True)

    with coverage("run", "-m", "graphflow", "up", "--no-console", "lab.yaml") as up:
        assert up.stdout is not None
        try:
            assert any("counted" in line for line in up.stdout)
            up.send_signal(signal.SIGINT)
            up.communicate(timeout=LIMIT)
        finally:
            up.kill()
    for words in (("combine", "-q"), ("json", "-q")):
        with coverage(*words) as done:
            assert done.wait(LIMIT) == 0
    [measured] = json.loads((tmp_path / "coverage.json").read_text())["files"].values()
    assert [NODE.splitlines()[line - 1].strip() for line in measured["missing_lines"]] == ["return 1"]
