"""Checks of declarations."""

from __future__ import annotations

import sys
from enum import IntEnum
from typing import Any

import pytest

from graphflow import DeclarationError, Group, Publisher
from graphflow.errors import Place
from graphflow.msgs import base
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.qos import SENSOR_DATA, Durability, Qos, Reliability
from graphflow.runtime.declarations import checks

HERE = Place("robot.py", 7)


class _Depths(IntEnum):
    FEW = 3


def test_what_is_right_passes() -> None:
    """No error is raised."""
    checks.check_type(String, base.Message, "Publisher", HERE)
    checks.check_type(AddTwoInts, base.Service, "Client", HERE)
    checks.check_type(Fibonacci, base.Action, "ActionClient", HERE)
    for name in ("chatter", "/a/b", "~/mine", "~"):
        checks.check_name(name, "Publisher", HERE)
    checks.check_on_event(None, "Publisher", HERE)
    checks.check_on_event(lambda self, event: None, "Publisher", HERE)
    checks.check_group(None, Group, "timer", HERE)
    checks.check_group(Group(1), Group, "timer", HERE)
    for rule in ("budget", "log", "end"):
        checks.check_on_error(rule, HERE)


@pytest.mark.parametrize(
    ("qos", "depth", "profile"),
    [
        (10, None, Qos(depth=10)),
        (3, None, Qos(depth=3)),
        (10, 3, Qos(depth=3)),
        (SENSOR_DATA, None, SENSOR_DATA),
        (_Depths.FEW, None, Qos(depth=3)),
        (Qos(lifespan_ns=100_000), None, Qos(lifespan_ns=100_000)),
        (Qos(deadline_ns=0), None, Qos()),
    ],
)
def test_one_profile_comes_of_qos_and_depth(qos: Qos | int, depth: int | None, profile: Qos) -> None:
    """A number is a depth, under either word."""
    assert checks.check_qos(qos, depth, HERE) == profile


def test_profiles_of_commands() -> None:
    """They may have any durations, which are those of publishers."""
    short = Qos(deadline_ns=5)
    assert checks.check_qos(short, None, Place(checks.__file__, 1)) == short


WRONG: list[tuple[Any, str]] = [
    (
        lambda: checks.check_qos(Durability.TRANSIENT_LOCAL, None, HERE),
        "not Durability.TRANSIENT_LOCAL, as in Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)",
    ),
    (lambda: checks.check_qos(10, Reliability.BEST_EFFORT, HERE), "as in Qos(reliability=Reliability.BEST_EFFORT)"),
    (
        lambda: checks.check_qos(Qos(lease_ns=20), None, HERE),
        "lease_ns=20 is in nanoseconds, too short for any message; for 20 ms write lease_ns=20_000_000",
    ),
    (
        lambda: checks.check_type("std_msgs/msg/String", base.Message, "Publisher", HERE),
        "not 'std_msgs/msg/String'; write from graphflow.msgs.std_msgs.msg import String, and then String without",
    ),
    (lambda: checks.check_type(AddTwoInts, base.Message, "Publisher", HERE), "Publisher needs a message class, not <c"),
    (lambda: checks.check_type(String(), base.Message, "Publisher", HERE), "Publisher needs a message class, not std_"),
    (lambda: checks.check_type("chatter", base.Message, "X", HERE), "not 'chatter'; the type comes first, then the na"),
    (lambda: checks.check_type(AddTwoInts.Request, base.Service, "X", HERE), "as in AddTwoInts, not its Request"),
    (lambda: checks.check_type(String, base.Action, "X", HERE), "X needs an action class, not <class"),
    (lambda: checks.check_name(String, "X", HERE), "X: the type comes first, then the name; <class "),
    (lambda: checks.check_name("a b", "X", HERE), "X: 'a b' is not a topic or service name"),
    (lambda: checks.check_qos(Qos(), 5, HERE), "give a Qos or a depth, not both: Qos(depth=5, ...) is both in one"),
    (lambda: checks.check_qos(20, 5, HERE), "give a Qos or a depth, not both"),
    (lambda: checks.check_qos(10, -1, HERE), "a queue depth cannot be -1"),
    (lambda: checks.check_qos("deep", None, HERE), "give a Qos or a queue depth such as 10, not 'deep'"),  # type: ignore[arg-type]
    (lambda: checks.check_on_event("heard", "X", HERE), "X: on_event= takes a method defined above it"),
    (
        lambda: checks.check_group("io", Group, "X", HERE),
        "X: group= takes a Group, not 'io'; write group=io, without quotes, below io = Group(1)",
    ),
    (lambda: checks.check_on_error("ignore", HERE), "on_error must be one of budget, log, end, not 'ignore'"),
]


@pytest.mark.parametrize(("check", "text"), WRONG, ids=[text[:40] for _, text in WRONG])
def test_what_is_wrong_is_told_with_its_place(check: Any, text: str) -> None:
    """And with the correct form."""
    with pytest.raises(DeclarationError) as caught:
        check()
    assert str(caught.value).startswith("robot.py:7: ")
    assert text in str(caught.value)


def test_the_place_is_that_of_the_declaration() -> None:
    """Of the caller of the calling function."""
    line = sys._getframe().f_lineno
    declared = Publisher(String, "chatter")

    assert declared.place == Place(__file__, line + 1)


async def idle() -> None:
    """Awaits nothing."""


async def waiting() -> None:
    await idle()


async def reading(items: Any) -> None:
    async for _ in items:
        pass


async def entering(lock: Any) -> None:
    async with lock:
        pass


@pytest.mark.parametrize(
    ("fn", "way"),
    [
        (idle, "it awaits nothing, so write def idle"),
        (waiting, r"await waiting\(\.\.\.\) directly"),
        (reading, r"await reading\(\.\.\.\) directly"),
        (entering, r"await entering\(\.\.\.\) directly"),
    ],
)
def test_a_coroutine_function_for_a_thread(fn: Any, way: str) -> None:
    """One that awaits nothing is a `def`; to await it here would block the loop."""
    with pytest.raises(DeclarationError, match=way):
        checks.check_plain(fn, "offload")
