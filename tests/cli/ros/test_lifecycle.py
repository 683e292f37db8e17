"""`graphflow lifecycle`, on a running graph."""

from __future__ import annotations

import json

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real

LISTED = "- {} [{}]\n\tStart: {}\n\tGoal: {}\n"


@slow
def test_a_life(machine: Machine) -> None:
    """The supervisor activates the node; the verbs deactivate and activate it, with ROS 2's output."""
    machine.run("up", "-d", "graphs/lifecycle.yaml")
    assert machine.look("lifecycle", "nodes") == "/lc_talker\n"
    assert machine.look("lifecycle", "nodes", "-c") == "1\n"
    assert machine.look("lifecycle", "get", "/lc_talker") == "active [3]\n"
    assert machine.look("lifecycle", "get") == "/lc_talker: active [3]\n"
    assert "active " in machine.look("ps")
    assert "ready, active for" in machine.look("status", "/lc_talker")
    assert machine.look("lifecycle", "list", "lc_talker") == (
        LISTED.format("deactivate", 4, "active", "deactivating")
        + LISTED.format("shutdown", 7, "active", "shuttingdown")
    )
    assert len(json.loads(machine.look("lifecycle", "list", "lc_talker", "-a", "--json"))) == 25
    for transition in ("deactivate", "2", "configure"):
        assert (
            machine.look("lifecycle", "set", "--include-hidden-nodes", "/lc_talker", transition)
            == "Transitioning successful\n"
        )
    assert json.loads(machine.look("lifecycle", "get", "--json")) == {"/lc_talker": {"id": 2, "label": "inactive"}}
    assert "inactive " in machine.look("ps")
    told = machine.look("lifecycle", "set", "/lc_talker", "configure", code=1)
    assert "Unknown transition requested, available ones are:\n- cleanup [2]\n- activate [3]\n- shutdown [6]" in told
    assert "error: /lc_listener is not a lifecycle node; lifecycle nodes: /lc_talker" in machine.look(
        "lifecycle", "get", "/lc_listener", code=2
    )
    label = machine.look("lifecycle", "get", "/lc_talker").partition(" ")[0]
    assert machine.look("lifecycle", "set", "/lc_talker", label, code=1) == f"error: /lc_talker is {label} already\n"
    machine.look("lifecycle", "set", "/lc_talker", "activate")
    for word in ("active", "activate"):
        assert machine.look("lifecycle", "set", "/lc_talker", word, code=1) == "error: /lc_talker is active already\n"
    told = machine.look("lifecycle", "get", "/nobody", code=1)
    assert told == "error: there is no node /nobody; there is /lc_talker\n"  # and not the other
    machine.look("down")
    log = machine.look("logs", "--node", "/lc_talker")
    assert "on_cleanup() is called after" in log
    assert log.count("on_shutdown() is called.") == 1


@slow
def test_a_node_that_cannot_be_brought_up(machine: Machine) -> None:
    """The graph does not come up, with the reason."""
    text = machine.run("up", "-d", "tests/programs/supervisor/refusing.yaml", code=1)
    assert "exit code 70 (an error in the node): /camera could not configure: on_configure refused: no camera" in text


@slow
def test_a_transition_that_is_refused(machine: Machine) -> None:
    """`set` fails, and tells the reason, which is in the node's log as well."""
    machine.run("up", "-d", "tests/programs/supervisor/refusing.yaml", "state:=unconfigured")
    told = machine.look("lifecycle", "set", "/camera", "configure", code=1)
    assert told.startswith("Transitioning failed\nerror: /camera is unconfigured\nmeanwhile /camera logged a")
    assert "on_configure refused: no camera" in told
    assert "on_configure refused: no camera" in machine.look("logs", "--node", "/camera")


def test_members_of_a_group_without_a_life_cycle(machine: Machine) -> None:
    """A group's `lifecycle:` is for those of its nodes that have one; one that fits none is a mistake."""
    assert machine.look("check", "tests/programs/supervisor/managed_group.yaml").startswith("tests/programs")
    told = machine.look("check", "tests/programs/supervisor/unmanaged.yaml", code=2)
    assert "unmanaged.yaml:5:16: Talker has no life cycle: derive it from LifecycleNode" in told
