"""`graphflow doctor hello`."""

from __future__ import annotations

import os
from collections import Counter

import pytest

from graphflow.cli.ros import hello
from tests.cases import slow, some
from tests.conftest import Machine


@pytest.mark.real
@slow
@pytest.mark.parametrize("words", some([("-ep", "0.05", "-pp", "0.5"), ()], ("-ep", "0.05", "-pp", "0.5")))
def test_hello(machine: Machine, words: tuple[str, ...]) -> None:
    """Two processes receive each other's greetings, and not their own."""
    first = machine.start("doctor", "hello", *words)
    first.wait_for("Subscribed from: nobody")
    second = machine.start("doctor", "hello", *words)
    name = os.uname().nodename
    first.wait_for(f"  {name}")
    second.wait_for("messages in")
    assert "MULTIMACHINE COMMUNICATION SUMMARY\nTopic: /canyouhearme, Published Msg Count: " in first.text
    assert first.end() == 0
    assert second.end() == 0
    assert "Subscribed from: nobody" in machine.run("doctor", "hello", "--once", "-pp", "0.3")


def test_greetings_of_strangers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only so many machines are counted, and their names are cut."""
    monkeypatch.setattr(hello, "HOSTS_BOUND", 2)
    monkeypatch.setattr(hello, "NAME_BOUND", 3)
    heard = Counter[str]()
    for host in ("first", "second", "third", "first"):
        hello._count(heard, f"{hello.HELLO}{host}")
    assert heard == {"fir": 2, "sec": 1}
