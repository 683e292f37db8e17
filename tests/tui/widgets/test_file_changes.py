"""Changes of a graph file: shown before they are written, and written atomically."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.tui.panes import Content
from graphflow.tui.widgets import file_changes
from graphflow.tui.widgets.dialogs import Ask
from tests.cases import slow
from tests.tui.stage import stage

pytestmark = pytest.mark.usefixtures("graphflow_runner")

TEXT = "# mine\nnodes: {/a: {class: nodes.talker:Talker}}\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "lab.yaml"
    made.write_text(TEXT)
    return made


@slow
async def test_the_windows_are_written(file: Path) -> None:
    """A key writes the windows after confirmation; comments stay."""
    async with stage(Content("nodes"), Content("log"), folder=file.parent) as s:
        await s.prefix("ctrl+s")
        await s.until("Write the windows of this console to lab.yaml?")
        await s.until("+console:")
        await s.press("w")
        await s.until("written to")
        assert file.read_text().startswith(TEXT)
        await s.prefix("ctrl+s")
        await s.until("needs no change")


@slow
@pytest.mark.parametrize(
    ("change", "why"),
    [("nodes: {", "lab"), ("nodes: {}", "there is no node"), ("nodes: {/a: {clas: x:Y}}", "unknown key 'clas'")],
)
async def test_what_would_be_no_graph_file_is_not_written(change: str, why: str, file: Path) -> None:
    """A change that would make the file invalid is not written."""
    async with stage(folder=file.parent) as s:
        file_changes.write_file(s.console, file, lambda _: change, "nothing good")
        assert why in s.console.messages[-1]
        assert not isinstance(s.console.screen, Ask)
        assert file.read_text() == TEXT
        assert [f.name for f in file.parent.iterdir()] == ["lab.yaml"]


@slow
async def test_a_full_disk_leaves_the_old_file(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The old file stays, and the error is shown."""

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    async with stage(folder=file.parent) as s:
        file_changes.write_file(s.console, file, lambda text: text + "# more\n", "a comment")
        monkeypatch.setattr("os.fsync", full)
        await s.press("w")
        await s.until("No space left on device; nothing was changed")
        assert file.read_text() == TEXT
        assert [f.name for f in file.parent.iterdir()] == ["lab.yaml"]


async def test_nodes_of_others_have_no_file(file: Path) -> None:
    """Nodes of others have no graph file; neither has a console on a robot."""
    async with stage(supervised=False) as s:
        file_changes.write_nodes(s.console, {"/a"}, lambda text, _: text, "x", lambda: None)
        assert "there is no graph file" in s.console.messages[-1]
