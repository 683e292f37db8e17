"""Exit codes: a contract with scripts."""

from __future__ import annotations

import re

import pytest

from graphflow import errors
from graphflow.cli import exits
from graphflow.cli.exits import exit_code
from graphflow.errors import UsageFault
from tests.conftest import Machine


def test_the_codes() -> None:
    """The numbers themselves never change."""
    assert (exits.OK, exits.FAILED, exits.USAGE, exits.NOT_RUNNING, exits.TIMEOUT) == (0, 1, 2, 3, 4)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (UsageFault("x"), exits.USAGE),
        (errors.GraphFileError([]), exits.USAGE),
        (errors.InterfaceError("x"), exits.USAGE),
        (errors.UnknownInterface("x"), exits.USAGE),
        (errors.InvalidName("x"), exits.USAGE),
        (errors.EncodeError("x"), exits.USAGE),
        (errors.SupervisorError("x"), exits.FAILED),
        (errors.SupervisorError("x", exits.NOT_RUNNING), exits.NOT_RUNNING),
        (errors.SupervisorError("x", exits.USAGE), exits.USAGE),
        (errors.CallTimeout("x"), exits.TIMEOUT),
        (errors.CallError("x"), exits.FAILED),
        (errors.ServiceUnavailable("x"), exits.FAILED),
        (errors.ServerLost("x"), exits.FAILED),
        (errors.RemoteError("ValueError", "x"), exits.FAILED),
        (errors.ParameterError("x"), exits.FAILED),
        (errors.TransportError("x"), exits.FAILED),
        (errors.GraphflowError("x"), exits.FAILED),
    ],
)
def test_what_a_command_ends_with(error: errors.GraphflowError, code: int) -> None:
    """The exit code tells wrong usage, no graph, a timeout and other failures apart."""
    assert exit_code(error) == code


@pytest.mark.parametrize(
    "words",
    [
        *(
            "node info",
            "param list",
            "param dump",
            "param describe",
            "lifecycle get",
            "lifecycle list",
            "groups",
            "logs",
        ),
        *("component list", "status", "stop", "start", "restart", "wait"),
        *("param get {} rate", "param set {} rate 3", "param delete {} rate", "lifecycle set {} configure"),
        *("groups limit {} a 2", "groups thread {} a", "groups move {} a b", "component unload tutorial {}"),
    ],
)
def test_a_node_that_is_not_there(standing: Machine, words: str) -> None:
    """The running graph is not as the command would have it, which is no wrong usage; what there is is named."""
    line = words if "{}" in words else f"{words} {{}}"
    told = standing.look(*line.format("/talkerr").split(), code=exits.FAILED)
    assert re.search(r"did you mean '/?talker'\?|there is |there are no lifecycle nodes here", told)
