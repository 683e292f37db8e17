"""Contexts."""

from __future__ import annotations

import pytest

from rclpy._rclpy_pybind11 import RCLError, UnknownROSArgsError
from rclpy.context import Context


def test_it_begins_and_ends_once() -> None:
    """A second end is rcl's error, which `try_shutdown` does not make."""
    context = Context()
    assert not context.ok()
    with pytest.raises(RuntimeError, match="must be initialized"):
        context.shutdown()
    context.init([], domain_id=5)
    assert context.ok()
    assert context.get_domain_id() == 5
    with pytest.raises(RuntimeError, match="only be called once"):
        context.init([])
    context.shutdown()
    assert not context.ok()
    with pytest.raises(RCLError, match="already called"):
        context.shutdown()
    assert not context.try_shutdown()


@pytest.mark.parametrize(
    ("args", "error", "text"),
    [
        (["--ros-args", "unknown"], UnknownROSArgsError, r"\['unknown'\]$"),
        (["--ros-args", "-params-file", "a"], UnknownROSArgsError, r"\['-params-file', 'a'\]; write --params-file$"),
        (["--ros-args", "-r", "__name:=bob", "--params", "a:=2"], UnknownROSArgsError, r"'a:=2'\]; write -p a:=2$"),
        (["--ros-args", "a:=b"], UnknownROSArgsError, r"\['a:=b'\]; write --ros-args -r a:=b$"),
        (["--ros-args", "-r", "no-rule"], RuntimeError, "no-rule"),
        (["--ros-args", "--log-level", "loud"], RuntimeError, "loud"),
        (["name\udcc3"], UnicodeEncodeError, "surrogates"),
    ],
)
def test_a_wrong_argument_is_an_error(args: list[str], error: type[Exception], text: str) -> None:
    """And nothing has begun."""
    context = Context()
    with pytest.raises(error, match=text):
        context.init(args)
    assert not context.ok()


def test_a_domain_is_not_negative() -> None:
    """In rclpy's words."""
    with pytest.raises(RuntimeError, match="should not be lower than zero"):
        Context().init([], domain_id=-1)


def test_its_end_is_told() -> None:
    """To methods of objects that are still there; to those who come later at once."""

    class Told:
        count = 0

        def end(self) -> None:
            Told.count += 1

    context, told, gone = Context(), Told(), Told()
    with context:
        context.on_shutdown(told.end)
        context.on_shutdown(gone.end)
        del gone
        with pytest.raises(TypeError, match="callable"):
            context.on_shutdown(3)  # type: ignore[arg-type]
    assert Told.count == 1
    context.on_shutdown(told.end)
    assert Told.count == 2
    context.destroy()


def test_words_that_miss_ros_are_told(caplog: pytest.LogCaptureFixture) -> None:
    """ROS 2 leaves them to the program."""
    context = Context()
    context.init(["me.py", "-ros-args", "-p", "a:=1"])
    context.shutdown()
    [text] = [record.getMessage() for record in caplog.records]
    assert text.startswith("'-ros-args' means nothing to ROS")
