"""What `up` shows; and log files, followed."""

from __future__ import annotations

import signal

import pytest

from tests.conftest import Machine
from tests.supervisor.running import nothing_is_left, rows, supervisor_of

pytestmark = pytest.mark.real


def test_up_shows_the_logs_and_ctrl_c_stops_everything(machine: Machine) -> None:
    """The first command of the README: a greeting, log lines, Ctrl-C, exit code 0, nothing left."""
    up = machine.start("up", "graphs/talker_listener.yaml", "rate:=20.0")
    up.wait_for("I heard")
    text = up.wait_for("Stop with Ctrl-C")
    assert "graph talker_listener is up: 2 nodes" in text
    assert "graphflow topic list" in text
    pids = [row["pid"] for row in rows(machine).values()] + [supervisor_of(machine)["pid"]]

    assert up.end(signal.SIGINT) == 0

    assert "Traceback" not in up.text
    assert "graph talker_listener has ended" in up.text
    nothing_is_left(machine, pids)
