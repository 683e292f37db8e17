"""The user's line that has called something, and whether it keeps what that returns."""

from __future__ import annotations

import json

from rclpy.impl.callers import Caller, caller


def test_the_line_and_its_result() -> None:
    """Whether it is kept, handed on or dropped."""
    found: list[Caller | None] = []

    def put() -> None:
        found.append(caller(1))
        assert found[-1] is not None
        drops.append(found[-1].drops_result)

    drops: list[bool] = []
    put()
    kept = [put()]  # type: ignore[func-returns-value]
    assert kept == [None]
    assert drops == [True, False]
    assert found[0] is not None
    line = test_the_line_and_its_result.__code__.co_firstlineno + 10
    assert str(found[0].place) == f"test_callers.py:{line}"


def test_code_that_is_not_the_users() -> None:
    """Python's own counts as none."""
    found: list[Caller | None] = []
    json.loads("{}", object_hook=lambda _: found.append(caller(1)))
    assert found == [None]


def test_a_method_of_a_call() -> None:
    """The call is chained to another one, with arguments or without."""
    found: list[bool] = []

    class Made:
        def ask(self, *_: object) -> None:
            asked = caller(1)
            assert asked is not None
            found.append(asked.is_chained)

    def make(*_: object) -> Made:
        return Made()

    made = make()
    made.ask()
    make(1).ask()
    kept = [make().ask()]  # type: ignore[func-returns-value]
    assert kept == [None]
    made.ask()
    assert found == [False, True, True, False]


def test_what_is_read_of_a_result() -> None:
    """At once, or from the variable that has it, until that has something else."""
    found: list[set[str]] = []

    class Made:
        read = kept = also = 0

        def ask(self) -> Made:
            asked = caller(1)
            assert asked is not None
            found.append(asked.reads)
            return self

    made = Made()
    assert made.ask().read == 0
    one = made.ask()
    assert (one.kept, made.read, one.also) == (0, 0, 0)
    one = made.ask()
    two = one = Made()
    made.ask()
    assert [made.ask()]
    assert two.read == one.read == 0
    assert found == [{"read"}, {"kept", "also"}, set(), set(), set()]
