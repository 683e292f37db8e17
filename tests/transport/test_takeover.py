"""Three terminals in any order find each other, whoever of them dies."""

from __future__ import annotations

import asyncio
import itertools
import signal
from types import SimpleNamespace
from typing import Any

import psutil
import pytest

from graphflow.transport import takeover
from graphflow.transport.rendezvous import address
from graphflow.transport.takeover import Takeover
from tests.cases import slow
from tests.conftest import Machine, Program

pytestmark = pytest.mark.real

TALKER = ("nodes.talker:Talker", "-p", "rate:=20.0")
LISTENER = ("nodes.listener:Listener",)
CIRCLE = ("nodes.draw_circle:DrawCircle",)


def nodes(machine: Machine) -> list[str]:
    return machine.run("node", "list", code=None).split()


def host(machine: Machine, programs: list[Program]) -> Program | None:
    """Which of the programs is the rendezvous."""
    _, port = address(machine.endpoint)
    for program in programs:
        if program.process.poll() is None:
            for connection in psutil.Process(program.pid).net_connections("tcp"):
                if connection.status == psutil.CONN_LISTEN and connection.laddr.port == port:
                    return program
    return None


ORDERS = itertools.permutations([TALKER, LISTENER, CIRCLE])


@slow
@pytest.mark.parametrize("order", [pytest.param(order, marks=slow if i else ()) for i, order in enumerate(ORDERS)])
def test_terminals_in_any_order_see_each_other(machine: Machine, order: tuple[tuple[str, ...], ...]) -> None:
    """No router, no multicast, no waiting: the listener hears the talker and a look shows all three."""
    programs = {words: machine.start("run", *words) for words in order}

    programs[LISTENER].wait_for("I heard")
    machine.until(lambda: nodes(machine) == ["/draw_circle", "/listener", "/talker"], "all three are seen")


@slow
def test_the_others_go_on_when_the_rendezvous_is_killed(machine: Machine) -> None:
    """They keep talking, one of them takes over, and a newcomer finds everyone; twice in a row."""
    programs = [machine.start("run", *words) for words in (CIRCLE, TALKER, LISTENER)]
    programs[2].wait_for("I heard")
    machine.until(lambda: host(machine, programs) is not None, "there is a rendezvous")

    for name in ("first_newcomer", "second_newcomer"):
        victim = host(machine, [*programs[:1], *programs[3:]]) or programs[0]
        victim.process.kill()
        victim.wait()
        programs[2].text = ""
        programs[2].wait_for("I heard")
        machine.until(lambda: host(machine, programs) is not None, "somebody took over")
        newcomer = machine.start("run", *LISTENER, "-r", f"__node:={name}")
        programs.append(newcomer)
        newcomer.wait_for("I heard")
        expected = {"/talker", "/listener", f"/{name}"}
        machine.until(lambda expected=expected: expected <= set(nodes(machine)), "all are seen")  # type: ignore[misc]


@slow
def test_a_node_that_is_killed_disappears_at_once(machine: Machine) -> None:
    """Its tokens go with its connection; no list shows a ghost."""
    talker, listener = machine.start("run", *TALKER), machine.start("run", *LISTENER)
    listener.wait_for("I heard")

    talker.process.kill()
    talker.wait()

    machine.until(lambda: nodes(machine) == ["/listener"], "the talker is gone")


@slow
def test_a_stopped_rendezvous_is_named(machine: Machine) -> None:
    """Commands and nodes say which process does not answer, and how to continue it."""
    talker = machine.start("run", *TALKER)
    talker.wait_for("Publishing")
    talker.process.send_signal(signal.SIGSTOP)
    try:
        for words in (("node", "list"), ("run", *LISTENER), ("up", "talker_listener")):
            text = machine.run(*words, code=1)
            assert f"process {talker.pid} (python" in text
            assert f"kill -CONT {talker.pid}" in text
    finally:
        talker.process.send_signal(signal.SIGCONT)
    machine.until(lambda: nodes(machine) == ["/talker"], "it answers again")


class _Alone:
    """A session that is connected to no rendezvous."""

    def routers(self) -> list[str]:
        return []

    def watch_transports(self, changed: object) -> Any:
        return SimpleNamespace(close=lambda: None)


async def test_who_holds_the_port_is_named_when_it_lasts(
    graphflow_runner: asyncio.Runner, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Once, and not after a first attempt in vain: short commands hold it in turn."""
    attempts: list[int] = []
    monkeypatch.setattr(takeover, "host", lambda: attempts.append(1))
    monkeypatch.setattr(takeover, "occupied", lambda endpoint, why: f"somebody {why}")
    monkeypatch.setattr(takeover, "_RETRY", 0.001)
    guard = Takeover(None)
    guard.guard(_Alone())  # type: ignore[arg-type]
    for enough, told in ((takeover._PATIENCE - 1, 0), (3 * takeover._PATIENCE, 1)):
        while len(attempts) < enough:
            await asyncio.sleep(0)
        assert [r.getMessage() for r in caplog.records] == ["somebody keeps newcomers from finding this process"] * told
    await guard.close()
