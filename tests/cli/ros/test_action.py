"""`graphflow action list`, `info`, `type` and `find`, and the arguments of `send_goal`."""

from __future__ import annotations

import json

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real

TYPE = "example_interfaces/action/Fibonacci"


def test_list(standing: Machine) -> None:
    """Names; with types; their number; JSON."""
    assert standing.look("action", "list") == "/fibonacci\n"
    assert standing.look("action", "list", "-t") == f"/fibonacci [{TYPE}]\n"
    assert standing.look("action", "list", "-c") == "1\n"
    assert json.loads(standing.look("action", "list", "--json")) == {"/fibonacci": [TYPE]}


def test_type_and_find(standing: Machine) -> None:
    """`type` and `find` are inverse; a type that no action has is not found."""
    assert standing.look("action", "type", "fibonacci") == f"{TYPE}\n"
    assert standing.look("action", "find", TYPE) == "/fibonacci\n"
    assert standing.look("action", "find", TYPE, "-c") == "1\n"
    assert "nothing is of type turtlesim" in standing.look("action", "find", "turtlesim/action/RotateAbsolute")
    assert "0\n" in standing.look("action", "find", "turtlesim/action/RotateAbsolute", "-c")
    assert json.loads(standing.look("action", "find", TYPE, "--json")) == ["/fibonacci"]


def test_info(standing: Machine) -> None:
    """`info` shows the servers and clients of an action."""
    assert standing.look("action", "info", "/fibonacci") == (
        "Action: /fibonacci\nAction clients: 1\n    /office/clerk\nAction servers: 1\n    /fibonacci_server\n"
    )
    assert standing.look("action", "info", "/fibonacci", "-t").endswith(f"    /fibonacci_server [{TYPE}]\n")
    assert standing.look("action", "info", "/fibonacci", "-c").endswith("Action clients: 1\nAction servers: 1\n")
    assert json.loads(standing.look("action", "info", "/fibonacci", "--json")) == {
        "action": "/fibonacci",
        "clients": [{"node": "/office/clerk", "type": TYPE}],
        "servers": [{"node": "/fibonacci_server", "type": TYPE}],
    }


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("type /fibonaci", "error: there is no action /fibonaci; did you mean '/fibonacci'?"),
        ("info /fibonaci", "error: there is no action /fibonaci; did you mean '/fibonacci'?"),
        ("send_goal /fibonaci", "error: there is no action /fibonaci; did you mean '/fibonacci'?"),
        (
            "send_goal /fibonacci",
            f"TYPE is missing; /fibonacci is of type {TYPE}: graphflow action send_goal /fibonacci {TYPE}",
        ),
        (
            "send_goal /fibonacci turtlesim/action/RotateAbsolute",
            f"/fibonacci is of type {TYPE}, not turtlesim/action/Rot",
        ),
        (f"send_goal /fibonacci {TYPE} {{ordr: 1}}", "did you mean 'order'?"),
    ],
)
def test_words_that_do_not_fit_the_graph(standing: Machine, words: str, told: str) -> None:
    """The error suggests existing names, and the exit code is 2."""
    assert told in standing.look("action", *words.split(), code=2)


def test_a_goal_that_succeeds(standing: Machine) -> None:
    """Goal, feedback and result are printed as in ROS 2."""
    text = standing.look("action", "send_goal", "/fibonacci", TYPE, "{order: 1}")
    assert "Sending goal:\n    order: 1\n" in text
    assert "Goal accepted with ID: " in text
    assert "Result:\n    sequence:\n    - 0\n    - 1\n" in text
    assert text.endswith("Goal finished with status: SUCCEEDED\n")


def test_a_goal_that_is_rejected(standing: Machine) -> None:
    """The exit code is 1."""
    assert "rejected" in standing.look("action", "send_goal", "/fibonacci", TYPE, "{order: -1}", code=1)


def test_a_goal_to_nobody(standing: Machine) -> None:
    """The nearest action is suggested at once; after the timeout, the exit code is 4."""
    words = ("send_goal", "/fibonaci", TYPE, "{order: 1}", "--timeout", "0.3")
    text = standing.look("action", *words, code=4)
    assert "there is no action /fibonaci yet; did you mean '/fibonacci'?\nWaiting for an action server" in text
    assert "error: no node offers the action /fibonaci" in text


@slow
def test_echo(standing: Machine) -> None:
    """The feedback of every goal, with the goal's id."""
    program = standing.start("action", "echo", "fibonacci", "--json", "--once")
    full = "/fibonacci/_action/feedback"
    standing.until(lambda: "_graphflow" in standing.look("topic", "info", "-v", full), "it listens")
    standing.run("action", "send_goal", "/fibonacci", TYPE, "{order: 3}")
    assert program.wait() == 0
    found = json.loads(program.text)
    assert found["feedback"]["sequence"][:3] == [0, 1, 1]
    assert len(found["goal_id"]["uuid"]) == 16


@slow
def test_a_goal_for_programs(standing: Machine) -> None:
    """Each event of the goal is a line of JSON."""
    text = standing.look("action", "send_goal", "/fibonacci", TYPE, "{order: 3}", "-f", "--json")
    told = [json.loads(line) for line in text.splitlines()]
    assert told[0]["event"] == "accepted"
    assert {one["event"] for one in told[1:-2]} == {"feedback"}
    assert told[-2] == {"event": "result", "result": {"sequence": [0, 1, 1, 2]}}
    assert told[-1] == {"event": "end", "status": "SUCCEEDED"}
