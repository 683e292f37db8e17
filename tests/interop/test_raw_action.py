"""An action as an independent client sees it, by ROS 2's hidden services and topics and bytes of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_a_bare_client_drives_an_action(machine: Machine) -> None:
    """One goal succeeds and its result can be asked for twice; one is cancelled; codes say what cannot be cancelled."""
    machine.start("run", "nodes.fibonacci_server:FibonacciServer")
    client = machine.start_python(str(Path(__file__).with_name("raw_action_client.py")))
    client.wait_for("DONE", 40.0)

    said = client.text.splitlines()
    answers = [line for line in said if line.split()[0] in ("ACCEPTED", "RESULT", "CANCEL")]
    assert answers == [
        "ACCEPTED 1111 1",
        "RESULT 1111 4 0 1 1 2",
        "RESULT 1111 4 0 1 1 2",
        "ACCEPTED 2222 1",
        "CANCEL 0 1 2222",
        "RESULT 2222 5 0 1 1",
        "CANCEL 3 0",
        "CANCEL 2 0",
        "RESULT 3333 0",
    ]
    assert [line for line in said if line.startswith("FEEDBACK")] == [
        "FEEDBACK 1111 0 1 1",
        "FEEDBACK 1111 0 1 1 2",
        "FEEDBACK 2222 0 1 1",
    ]
    # An empty list may come first: the server tells it when it opens.
    states = [line for line in said if line.startswith("STATUS ")]
    assert states[:3] == ["STATUS 1111:1", "STATUS 1111:2", "STATUS 1111:4"]
    assert states[3:] == [f"STATUS 1111:4 2222:{state}" for state in (1, 2, 3, 5)]
