"""Questions to a process over a real network: each is answered, but of a flood only so many as can wait."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator

import pytest
import zenoh

from graphflow.transport.config import callback_threads
from graphflow.transport.questions import BOUND, FLOOD, Questions
from graphflow.transport.zenoh import ZenohSession
from tests.cases import slow
from tests.conftest import LIMIT
from tests.until import until

pytestmark = pytest.mark.real

KEY = "questions/mine"


class Asked:
    """A process that is asked by another: what it answers, and until when."""

    def __init__(self, mine: zenoh.Session, other: zenoh.Session) -> None:
        self._other = other
        self.taken, self.goes_on, self._ended = threading.Event(), threading.Event(), threading.Semaphore(0)
        self.goes_on.set()
        self.answers: list[zenoh.Reply] = []
        before = {*callback_threads()}
        self.questions = Questions(mine, KEY, self._answer)
        (self.thread,) = {*callback_threads()} - before
        until(lambda: list(other.get(KEY)), "there is a way to it")

    def _answer(self, query: zenoh.Query) -> None:
        self.taken.set()
        assert self.goes_on.wait(LIMIT)
        with query:
            query.reply(KEY, b"told")

    def ask(self, number: int) -> None:
        for _ in range(number):
            handler = zenoh.handlers.Callback(self.answers.append, drop=self._ended.release, indirect=False)
            self._other.get(KEY, handler, timeout=LIMIT)

    def wait_ended(self, number: int) -> None:
        for _ in range(number):
            assert self._ended.acquire(timeout=LIMIT)

    def flood(self, bound: int) -> None:
        """While one question is being answered, so many more come that only the first or last `bound` can wait."""
        self.goes_on.clear()
        self.taken.clear()
        self.answers.clear()
        self.ask(1)
        assert self.taken.wait(LIMIT)
        self.ask(3_000)
        self.wait_ended(3_000 - bound)
        assert not self.answers
        self.goes_on.set()
        self.wait_ended(bound + 1)
        assert len(self.answers) == bound + 1
        self.ask(1)
        self.wait_ended(1)
        assert len(self.answers) == bound + 2


@pytest.fixture
def asked(graphflow_runner: asyncio.Runner, foreign_router: zenoh.Session) -> Iterator[Asked]:
    async def made() -> ZenohSession:
        return ZenohSession(asyncio.get_running_loop())

    mine = graphflow_runner.run(made())
    it = Asked(mine.raw, foreign_router)
    yield it
    it.goes_on.set()
    mine.raw.close()  # type: ignore[no-untyped-call]
    it.thread.join(LIMIT)
    assert not it.thread.is_alive()


@slow
def test_a_flood_of_questions(asked: Asked) -> None:
    """More than can wait are ended without an answer, from the second flood on by Zenoh; the next is answered."""
    asked.flood(FLOOD)
    asked.flood(BOUND)
    asked.flood(BOUND)


def test_the_thread_ends_with_the_session(asked: Asked) -> None:
    """Also where nothing was undeclared before."""
    asked.ask(3)
    asked.wait_ended(3)
    assert len(asked.answers) == 3
    asked.questions._session.close()  # type: ignore[no-untyped-call]


def test_a_flood_of_questions_to_one_that_leaves(asked: Asked) -> None:
    """It does not put a ring in the place of what is no longer there."""
    asked.goes_on.clear()
    asked.ask(1)
    assert asked.taken.wait(LIMIT)
    asked.ask(2 * FLOOD)
    asked.wait_ended(FLOOD)
    asked.questions.undeclare()
    asked.goes_on.set()
    asked.thread.join(LIMIT)
    assert not asked.questions._ring


def test_an_answer_that_fails(asked: Asked, monkeypatch: pytest.MonkeyPatch) -> None:
    """The question ends without one, and the next is answered."""
    replied: list[zenoh.Query] = []

    def take(query: zenoh.Query) -> None:
        replied.append(query)
        raise ValueError("it fails")

    monkeypatch.setattr(asked.questions, "_take", take)
    asked.ask(1)
    until(lambda: replied)
    replied.clear()
    asked.wait_ended(1)
    monkeypatch.undo()
    asked.ask(1)
    asked.wait_ended(1)
    assert len(asked.answers) == 1
