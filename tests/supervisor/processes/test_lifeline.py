"""The lifeline of a supervisor: how it hears of the end of the command that has started it."""

from __future__ import annotations

import os
import queue
from functools import partial

import pytest

from graphflow.supervisor.processes.lifeline import LET_GO, Lifeline


@pytest.mark.parametrize(("said", "told"), [(b"", "cut"), (LET_GO, "left")])
def test_the_end_of_a_command_is_told(said: bytes, told: str) -> None:
    """Whether it has let go of its graph or not: a console that was killed will not come to follow it."""
    read, write = os.pipe()
    heard = queue.SimpleQueue[str]()
    lifeline = Lifeline(read, partial(heard.put, "early"))
    lifeline.on_cut(partial(heard.put, "cut"), partial(heard.put, "left"))
    lifeline.watch()
    os.write(write, said)
    os.close(write)
    assert heard.get(timeout=5.0) == told
    os.close(read)


def test_a_command_that_ends_early() -> None:
    """Before anybody has said what is to be done then, it is what the lifeline was made with."""
    read, write = os.pipe()
    heard = queue.SimpleQueue[str]()
    lifeline = Lifeline(read, partial(heard.put, "early"))
    lifeline.watch()
    os.close(write)
    assert heard.get(timeout=5.0) == "early"
    os.close(read)
