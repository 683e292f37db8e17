"""The page about notebooks, run as one: in a kernel of Jupyter's, cell after cell."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import nbclient
import nbformat
import pytest

from tests.cases import slow
from tests.conftest import PROJECT, Machine
from tests.docs.test_docs import blocks

pytestmark = pytest.mark.real

PAGE = PROJECT / "docs" / "notebooks.md"
LIMIT = 40
"""Seconds that a cell may take."""


def run_cells(sources: list[str], machine: Machine, folder: Path, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Run cells in a new kernel of this interpreter; returns them with their outputs."""
    spec = {
        "argv": [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"],
        "display_name": "this one",
        "language": "python",
    }
    kernel = folder / "jupyter" / "kernels" / "this" / "kernel.json"
    kernel.parent.mkdir(parents=True)
    kernel.write_text(json.dumps(spec))
    for name, value in {**machine.env, "JUPYTER_PATH": str(folder / "jupyter"), "IPYTHONDIR": str(folder)}.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(folder / "jupyter"))
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in sources])  # type: ignore[no-untyped-call]
    nbclient.NotebookClient(
        notebook, timeout=LIMIT, kernel_name="this", resources={"metadata": {"path": folder}}
    ).execute()
    return list(notebook.cells)


def shown(cell: Any) -> str:
    """What a cell shows, as text; of pictures, their kinds."""
    texts = []
    for output in cell.outputs:
        texts += [output.text] if output.output_type == "stream" else [f"<{kind}>" for kind in output.data]
        texts += [output.data["text/plain"]] if "text/plain" in output.get("data", {}) else []
    return "".join(texts)


@slow
def test_the_page(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No cell fails; numbers, logged errors, the turtle and the plot appear in the cells that make them."""
    sources = [block.text for block in blocks(PAGE, "python")]
    wave, hasty, _, drive, turtle, plot, end = map(shown, run_cells(sources, machine, tmp_path, monkeypatch))
    low, high = map(float, wave.split())
    assert 0.0 <= low < high <= 1.0
    assert "[ERROR]" in hasty
    assert "[hasty]: there is no arm" in hasty
    assert drive.endswith("80")
    assert "<image/svg+xml>" in turtle
    assert "<image/png>" in plot
    assert end == ""


@slow
def test_a_class_that_is_written_again(machine: Machine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The new one is used, and an error in a handler appears with its line; `run` says what to write in its place."""
    head = "import asyncio, graphflow\nfrom graphflow import Node, timer\n"
    node = "class Robot(Node):\n    @timer(0.05)\n    async def tick(self): {}\n"
    go = "async with graphflow.running(Robot()):\n    await asyncio.sleep(0.2)\n"
    run = "try:\n    graphflow.run(Robot)\nexcept RuntimeError as error:\n    print(error)\n"
    sources = [head + node.format("self.log.error('old')"), go, node.format("1 / 0"), go, run]
    _, first, _, second, refused = map(shown, run_cells(sources, machine, tmp_path, monkeypatch))
    assert "[robot]: old" in first
    assert "ZeroDivisionError" in second
    assert "old" not in second
    assert "async with graphflow.running(Robot()):" in refused
