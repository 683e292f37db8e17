"""Results that are asked for at once."""

from __future__ import annotations

import pytest

from rclpy.impl.mistakes import early_results
from rclpy.task import Future


def ask() -> Future[int]:
    """Be answered later."""
    return Future()


def test_a_result_in_the_line_of_the_request(caplog: pytest.LogCaptureFixture) -> None:
    """It is told once; code that looks at a future again and again is left alone."""
    for _ in range(2):
        early = ask().result()  # told
        assert early is None
    future = ask()
    assert future.result() is None
    future.set_result(1)
    assert [future].pop().result() == 1
    line = test_a_result_in_the_line_of_the_request.__code__.co_firstlineno + 3
    [text] = [record.getMessage() for record in caplog.records]
    assert text.startswith(f"test_early_results.py:{line}: future.result() is None until the future is done: ")


def test_code_that_is_compiled_again_and_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A limited number of calls is remembered."""
    monkeypatch.setattr(early_results, "_seen", seen := set[object]())
    monkeypatch.setattr(early_results, "SEEN_BOUND", 3)
    for number in range(5):
        exec(f"answer_{number} = ask().result()", {"ask": ask})
    assert len(seen) == 3
