"""Environment variables: those that are read, and misspelt ones."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from graphflow.cli.main import main
from graphflow.cli.variables import KNOWN, PREFIX, misspelt

PACKAGE = Path(__file__).parents[2] / "graphflow"


def test_all_that_are_read_are_known() -> None:
    """The list has each name that is in the source, and no other."""
    found = {word for file in PACKAGE.rglob("*.py") for word in re.findall(rf"{PREFIX}([A-Z]\w+)", file.read_text())}
    shell = (PACKAGE / "rclpy" / "bin" / "ros2").read_text()
    assert found | set(re.findall(rf"{PREFIX}([A-Z]\w+)", shell)) == set(KNOWN)


@pytest.mark.parametrize(
    ("variable", "meant"),
    [
        ("GRAPHFLOW_DOMAINS", "GRAPHFLOW_DOMAIN"),
        ("GRAPHFLOW_RENDEVOUS", "GRAPHFLOW_RENDEZVOUS"),
        ("GRAPHFLOW_DOMAIN", None),
        ("GRAPHFLOW_OF_MY_OWN", None),
        ("DOMAINS", None),
    ],
)
def test_a_misspelt_variable(variable: str, meant: str | None) -> None:
    """A misspelt variable is reported with the probable one; unrelated variables are not."""
    assert list(misspelt([variable])) == ([f"nothing reads {variable}; did you mean {meant}?"] if meant else [])


def test_a_command_tells_it(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Once, and on the error output, so that scripts have what they read."""
    monkeypatch.setenv("GRAPHFLOW_DOMAINS", "5")
    with pytest.raises(SystemExit):
        main(["schema"])
    out, err = capsys.readouterr()
    assert out.startswith("{")
    assert err == "note: nothing reads GRAPHFLOW_DOMAINS; did you mean GRAPHFLOW_DOMAIN?\n"
