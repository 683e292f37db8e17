"""`action send_goal` and Ctrl-C."""

from __future__ import annotations

import shutil
import signal
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import PROGRAMS, Machine

pytestmark = pytest.mark.real


@slow
def test_ctrl_c_before_the_goal_is_accepted_withdraws_it(machine: Machine, tmp_path: Path) -> None:
    """The withdrawal is reported, and the goal never starts."""
    shutil.copy(PROGRAMS / "verbs" / "hesitant.py", tmp_path)
    server = machine.start("run", "hesitant:Hesitant", cwd=tmp_path)
    server.wait_for("starts")
    goal = ("action", "send_goal", "/compute", "example_interfaces/action/Fibonacci")
    sending = machine.start(*goal, "{order: 8}")
    server.wait_for("ponders 8")
    assert sending.end(signal.SIGINT) == 0
    assert "Goal withdrawn before it was accepted.\n" in sending.text

    machine.run(*goal, "{order: 9}")
    assert "begins 9" in server.wait_for("begins 9")
    assert "begins 8" not in server.text
    assert server.end() == 0
