"""The output of programs for graph files, and the errors of those that fail."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest

from graphflow.markup.substitutions import Outside, SubstitutionError, Substitutions
from graphflow.supervisor.launching import command_output as module


def apply(text: str, folder: Path, env: dict[str, str] | None = None) -> Any:
    outside = Outside({**os.environ, **(env or {})}, folder, folder, run=module.printed)
    return Substitutions({}, folder / "lab.yaml", outside).apply(text)


@pytest.mark.parametrize(
    ("text", "output"),
    [
        ("$(command 'cat robot.urdf')", "<robot/>\n"),
        ("$(command cat robot.urdf)", "<robot/>\n"),
        ("$(command 'cat $(dirname)/robot.urdf' fail)", "<robot/>\n"),
        ("$(command 'sh -c \"echo $WHO; echo oh >&2\"' ignore)", "ada\n"),
        ("$(command 'sh -c \"echo $WHO; echo oh >&2\"' warn)", "ada\n"),
        ("$(command 'sh -c \"echo oh >&2\"' capture)", "oh\n"),
        ("$(command 'echo \"a b\"')", "a b\n"),
        ("$(command true)", ""),
    ],
)
def test_what_a_program_prints(text: str, output: str, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """It runs in the folder of the file, without a shell."""
    (tmp_path / "robot.urdf").write_text("<robot/>\n")
    assert apply(text, tmp_path, {"WHO": "ada"}) == output
    assert ("oh" in caplog.text) is ("warn" in text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("$(command 'no_such_program x')", "there is no program 'no_such_program' on the PATH"),
        ("$(command 'sh -c \"echo oh >&2; exit 3\"')", "exit code 3: oh"),
        ("$(command 'false' ignore)", "$(command false): exit code 1"),
        ("$(command 'sh -c \"echo oh >&2\"')", "wrote to its error output: oh; to allow that: $(command '...' warn)"),
        ("$(command 'sleep 60')", "it has not ended within 0.2 s"),
        ("$(command 'head -c 100001 /dev/zero')", "it printed more than 100,000 characters"),
        ("$(command 'printf \\\\\\\\377')", "can't decode byte 0xff"),
    ],
)
def test_a_program_that_fails(text: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The error has the last line of its error output."""
    if "sleep" in text:
        monkeypatch.setattr(module, "LIMIT", 0.2)
    with pytest.raises(SubstitutionError) as caught:
        apply(text, tmp_path)
    assert message in str(caught.value)


def test_a_program_that_asks_where_a_package_is(tmp_path: Path) -> None:
    """As xacro does; of its complaint the line that says what is wrong is told."""
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    asks = "from ament_index_python import get_package_share_directory as f; print(f('%s'))"
    (tmp_path / "ask.py").write_text(asks % "arm")
    assert Path(apply(f"$(command '{sys.executable} ask.py')", tmp_path).strip()).name == "arm"
    (tmp_path / "ask.py").write_text("import sys; sys.exit('error: no such file\\nwhen processing it')")
    with pytest.raises(SubstitutionError, match=r"exit code 1: error: no such file$"):
        apply(f"$(command '{sys.executable} ask.py')", tmp_path)
