"""Tracebacks as a program's author wants to see them."""

from __future__ import annotations

import signal
import sys
import threading
import traceback
from collections.abc import Callable
from typing import Any

import pytest
from std_msgs.msg import String

import rclpy
from graphflow.rclpy.hints import lookup, tracebacks
from rclpy._rclpy_pybind11 import RCLError
from rclpy.node import Node


def raised(fn: Callable[[], object]) -> BaseException:
    """What `fn` raises, its traceback shortened."""
    try:
        fn()
    except BaseException as error:
        tracebacks.shorten(error)
        return error
    raise AssertionError("nothing was raised")


def functions(error: BaseException) -> list[str]:
    return [frame.name for frame in traceback.extract_tb(error.__traceback__)]


def test_only_own_frames_of_an_interruption(node: Node) -> None:
    """What runs the callback is left out, and so is Python's own code below it."""

    def tick() -> None:
        raise KeyboardInterrupt

    node.create_timer(0.0, tick)
    assert functions(raised(lambda: rclpy.spin(node))) == ["raised", "<lambda>", "tick"]


def test_the_place_of_an_error_stays(node: Node) -> None:
    """An error of Python's kinds is shown with the place where it was raised, and without what lies between."""

    def tick() -> None:
        node.declare_parameters("", 1)  # type: ignore[arg-type]

    node.create_timer(0.0, tick)
    found = functions(raised(lambda: rclpy.spin(node)))
    assert found[:4] == ["raised", "<lambda>", "tick", "declare_parameters"]
    assert "spin" not in found


@pytest.mark.parametrize(
    "wrong",
    [
        lambda node: node.declare_parameter(1.0),
        lambda node: node.create_publisher(String, "chat", "10"),
        lambda node: node.create_publisher(String, "chat", 10, 11),
        lambda node: node.create_publisher(String, "chat", 10).publish("hello"),
        lambda node: String(data=1),
        lambda node: node.create_rate("1"),
        lambda node: node.set_parameters(1),
    ],
)
def test_arguments_that_are_refused(node: Node, wrong: Callable[[Node], object]) -> None:
    """The text says it all: the last line shown is the caller's."""
    assert functions(raised(lambda: wrong(node))) == ["raised", "<lambda>", "<lambda>"]


def test_errors_that_led_to_an_error(node: Node) -> None:
    """Are shortened, too."""

    def end() -> None:
        try:
            rclpy.spin(node)
        finally:
            node.context.shutdown()

    def tick() -> None:
        node.context.shutdown()
        raise KeyboardInterrupt

    node.create_timer(0.0, tick)
    error = raised(end)
    assert isinstance(error, RCLError)
    assert functions(error) == ["raised", "end"]
    assert error.__context__ is not None
    assert functions(error.__context__) == ["end", "tick"]


def test_an_error_without_own_frames() -> None:
    """Is shown as it is; an interruption with nothing but its name."""
    found = []
    for kind in (ValueError, KeyboardInterrupt):
        error = kind()
        try:
            names: dict[str, Any] = {}
            exec(compile("def fail(error): raise error", tracebacks.__file__, "exec"), names)
            names["fail"](error)
        except (ValueError, KeyboardInterrupt):
            assert error.__traceback__ is not None
            error.__traceback__ = error.__traceback__.tb_next
        tracebacks.shorten(error)
        found.append(functions(error))
    assert found == [["fail"], []]


def test_hooks(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Errors of the main thread and of others are shown that way, where nobody else shows them."""
    monkeypatch.setattr(sys, "excepthook", sys.__excepthook__)
    monkeypatch.setattr(threading, "excepthook", threading.__excepthook__)
    tracebacks.install()
    thread = threading.Thread(target=rclpy.spin_once, args=(None,), name="spinner")
    thread.start()
    thread.join(10)
    error = raised(lambda: rclpy.init(args=["--ros-args", "--what"]))
    sys.excepthook(type(error), error, error.__traceback__)
    shown = capsys.readouterr().err
    assert "Exception in thread spinner:" in shown
    assert "UnknownROSArgsError" in shown.splitlines()[-1]
    assert "context.py" not in shown

    def others(*_: object) -> None:
        """Show it another way."""

    monkeypatch.setattr(sys, "excepthook", others)
    tracebacks.install()
    assert sys.excepthook is others


@pytest.mark.parametrize("place", [(lookup, "hint"), (tracebacks, "explain"), (sys, "__excepthook__")])
@pytest.mark.parametrize("kind", [ValueError, KeyboardInterrupt])
def test_an_interrupt_in_the_hook(
    kind: type[BaseException],
    place: tuple[Any, str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """It is ignored: the error is shown whole, and Ctrl-C works again afterwards."""
    real, former = getattr(*place), signal.getsignal(signal.SIGINT)

    def interrupted(*given: Any) -> Any:
        signal.raise_signal(signal.SIGINT)
        return real(*given)

    monkeypatch.setattr(*place, interrupted)
    tracebacks.show(kind, kind("the reason"))
    assert capsys.readouterr().err == f"{kind.__name__}: the reason\n"
    assert signal.getsignal(signal.SIGINT) is former


def test_an_interrupt_before_the_hook(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """It is raised where the hook sets the handler, and is ignored, too."""
    real, late = signal.signal, [KeyboardInterrupt]

    def pending(number: int, handler: Any) -> Any:
        if late:
            raise late.pop()
        return real(number, handler)

    monkeypatch.setattr(signal, "signal", pending)
    tracebacks.show(ValueError, ValueError("the reason"))
    assert capsys.readouterr().err == "ValueError: the reason\n"


def test_an_error_shown_in_another_thread(capsys: pytest.CaptureFixture[str]) -> None:
    """Signals are the main thread's; the error is shown as it is there."""
    thread = threading.Thread(target=tracebacks.show, args=(ValueError, ValueError("the reason")))
    thread.start()
    thread.join(10)
    assert capsys.readouterr().err == "ValueError: the reason\n"


def test_the_hook_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Is there from `rclpy.init` on."""
    monkeypatch.setattr(threading, "excepthook", threading.__excepthook__)
    rclpy.init()
    assert threading.excepthook is not threading.__excepthook__
    monkeypatch.setattr(threading, "excepthook", print)
    tracebacks.install_in_threads()
    assert threading.excepthook is print
