"""`graphflow router`."""

from __future__ import annotations

import signal

import pytest

from tests.cases import slow, some
from tests.conftest import Machine

pytestmark = pytest.mark.real


WORDS = [("router",), ("run", "rmw_zenoh_cpp", "rmw_zenohd")]


@slow
@pytest.mark.parametrize("words", some(WORDS, WORDS[1]))
def test_it_is_the_rendezvous(machine: Machine, words: tuple[str, ...]) -> None:
    """The router starts as rendezvous, also under ROS 2's name; a second one waits to take over."""
    first = machine.start(*words)
    first.wait_for("find each other at")
    assert first.text.startswith("Started Zenoh router with id ")
    second = machine.start("router")
    second.wait_for("takes over when that ends")
    zid = first.text.splitlines()[0].rpartition(" ")[2]
    assert f", with id {zid}" in second.text
    assert "no topics in domain" in machine.look("topic", "list")
    assert first.end(signal.SIGINT) == 0
    assert second.end(signal.SIGINT) == 0
