"""`graphflow node list` and `node info`."""

from __future__ import annotations

import json

import pytest

from graphflow.cli.ros.node import _warn_of_twins
from tests.cases import slow
from tests.conftest import Machine

NODES = ["/fibonacci_server", "/listener", "/office/auditor", "/office/clerk", "/talker"]


@pytest.mark.real
def test_list(standing: Machine) -> None:
    """Full names, sorted; or their number; or JSON."""
    assert standing.look("node", "list").split() == NODES
    assert standing.look("node", "list", "--count-nodes") == "5\n"
    assert json.loads(standing.look("node", "list", "--json")) == NODES


@slow
@pytest.mark.real
def test_hidden_nodes_are_listed_when_asked_for(standing: Machine) -> None:
    """A command that takes part in the graph is a node, which `-a` shows."""
    echo = standing.start("topic", "echo", "/chatter")
    echo.wait_for("data: ")
    assert f"/_graphflow_{echo.pid}" in standing.look("node", "list", "-a")
    assert standing.look("node", "list").split() == NODES
    assert echo.end() == 0


@pytest.mark.real
def test_info(standing: Machine) -> None:
    """A node's endpoints are printed as in ROS 2."""
    lines = standing.look("node", "info", "/office/clerk").splitlines()
    titles = ["Subscribers", "Publishers", "Service Servers", "Service Clients", "Action Servers", "Action Clients"]
    assert [line for line in lines if line.endswith(":")] == [f"  {title}:" for title in titles]
    assert lines[:3] == ["/office/clerk", "  Subscribers:", "  Publishers:"]
    for title, entry in (
        ("  Publishers:", "    /office/minutes: std_msgs/msg/String"),
        ("  Service Servers:", "    /office/clerk/add: example_interfaces/srv/AddTwoInts"),
        ("  Service Clients:", "    /bank/add: example_interfaces/srv/AddTwoInts"),
        ("  Action Clients:", "    /fibonacci: example_interfaces/action/Fibonacci"),
    ):
        assert lines[lines.index(title) + 1] == entry
    served = standing.look("node", "info", "/fibonacci_server").partition("Action Servers:\n")[2]
    assert served.startswith("    /fibonacci: example_interfaces/action/Fibonacci\n")


@pytest.mark.real
def test_info_of_what_is_hidden(standing: Machine) -> None:
    """Hidden names are shown on request, and QoS with `-v`."""
    words = ("node", "info", "/office/clerk")
    assert "/office/_drawer" not in standing.look(*words)
    text = standing.look(*words, "--include-hidden", "-v")
    assert "    /office/_drawer: std_msgs/msg/String  (RELIABLE, VOLATILE, KEEP_LAST (" in text
    assert "    /office/minutes: std_msgs/msg/String  (BEST_EFFORT, VOLATILE, KEEP_LAST (7))\n" in text


@pytest.mark.real
def test_info_for_programs(standing: Machine) -> None:
    """Types by name, in the same four sections."""
    found = json.loads(standing.look("node", "info", "/office/clerk", "--json"))
    assert found["node"] == "/office/clerk"
    assert found["publishers"]["/office/minutes"] == "std_msgs/msg/String"
    assert found["service_clients"] == {"/bank/add": "example_interfaces/srv/AddTwoInts"}
    assert "/office/_drawer" not in found["publishers"]


@pytest.mark.real
@pytest.mark.parametrize(
    ("name", "told"),
    [("clerk", "error: there is no node /clerk; did you mean '/office/clerk'?"), ("/x", "error: there is no node /x")],
)
def test_a_node_that_is_not_there(standing: Machine, name: str, told: str) -> None:
    """The nearest name is suggested, and the exit code is 1."""
    assert standing.look("node", "info", name, code=1).startswith(told)


def test_twins_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    """Two nodes of one name cause a warning, once for each name."""
    _warn_of_twins(["/a", "/b"])
    assert capsys.readouterr() == ("", "")
    _warn_of_twins(["/a", "/a", "/a", "/b"])
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("WARNING: Be aware that there are nodes in the graph that share an exact name")
    assert err.endswith(": /a\n")
