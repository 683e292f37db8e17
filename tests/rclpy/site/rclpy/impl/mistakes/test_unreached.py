"""Calls that come after `rclpy.spin(node)`, which ends only with the program."""

from __future__ import annotations

import ast
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import ModuleType

import pytest

import rclpy
from rclpy.context import Context
from rclpy.impl.deadlock import waiting
from rclpy.impl.mistakes import unreached
from rclpy.node import Node
from tests.until import until

Caplog = pytest.LogCaptureFixture
HEAD = """
import rclpy
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Empty


class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        self.client = self.create_client(Empty, "clear")
        self.pub = None

    def ask(self):
        return self.ask_really()

    def ask_really(self):
        return self.client.call_async(Empty.Request())

    def save(self):
        self.get_logger().info("saved")


def main(executor):
    node = Asker()
"""


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unreached, "WARN_AFTER", 0.05)
    monkeypatch.setattr(unreached, "LOOK_EVERY", 0.01)
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)


@pytest.fixture
def told(node: Node, tmp_path: Path, caplog: Caplog) -> Callable[[str], list[str]]:
    """Runs a program in a thread of its own, until its spin has been looked at; returns what was told of it."""

    def run(body: str) -> list[str]:
        file = tmp_path / "late.py"
        file.write_text(HEAD + "".join(f"    {line}\n" for line in body.splitlines()))
        module = ModuleType("late")
        exec(compile(file.read_text(), str(file), "exec"), module.__dict__)
        executor = rclpy.executors.SingleThreadedExecutor()

        def main() -> None:
            with suppress(Exception):  # the context is shut down
                module.main(executor)

        thread = threading.Thread(target=main)
        thread.start()
        life = node.context.life
        assert life is not None
        watches = life.network().elsewhere[0].watches  # type: ignore[attr-defined]
        watch = next(one for one in watches.each if isinstance(one, unreached.Unreached))
        until(lambda: any(code.co_filename == str(file) for code, _ in list(watch._read)))
        texts = [r.getMessage() for r in caplog.records if "comes after" in r.getMessage()]
        rclpy.shutdown()
        thread.join(5.0)
        return texts

    return run


LINE = HEAD.count("\n") + 1
"""The first line of a program's own part."""
WAY = "which does not return: {} is not called before that ends; call it before, or leave that out"


@pytest.mark.parametrize(
    ("body", "line", "spin", "name"),
    [
        ("rclpy.spin(node)\nnode.ask()", 1, "rclpy.spin(node)", "ask"),
        ("rclpy.spin(node)\nnode.save()\nf = node.client.call_async(None)", 2, "rclpy.spin(node)", "call_async"),
        ("try:\n  rclpy.spin(node)\n  print(node.ask())\nfinally:\n  pass", 2, "rclpy.spin(node)", "ask"),
        ("if node:\n  rclpy.spin(node)\nnode.ask()", 2, "rclpy.spin(node)", "ask"),
        ("executor.add_node(node)\nexecutor.spin()\nnode.ask()", 2, "executor.spin()", "ask"),
    ],
)
def test_calls_after_a_spin(told: Callable[[str], list[str]], body: str, line: int, spin: str, name: str) -> None:
    """What needs other nodes is told, with its line and the spin."""
    assert told(body) == [f"late.py:{LINE + line} comes after {spin}, {WAY.format(name)}"]


def test_several_contexts(node: Node) -> None:
    """The watch of each sees the spins of its own, so that a spin is told once."""
    own, other = node.context.life, Context()
    rclpy.init(context=other)
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)

    def main() -> None:
        with suppress(rclpy.executors.ExternalShutdownException):
            executor.spin()

    thread = threading.Thread(target=main)
    thread.start()
    assert own is not None
    assert other.life is not None
    spinning = until(lambda: list(unreached._spinning(own)))
    assert [frame.f_code.co_name for frame in spinning] == ["main"]
    assert list(unreached._spinning(other.life)) == []
    rclpy.shutdown(context=other)
    rclpy.shutdown()
    thread.join(5.0)


def test_a_thread_that_was_to_spin(told: Callable[[str], list[str]], caplog: Caplog) -> None:
    """The spin in its arguments is told, and not what comes after it."""
    assert told("import threading\nthreading.Thread(target=rclpy.spin(node)).start()\nnode.ask()") == []
    assert [text for text in caplog.messages if "target=" in text] == [
        f"late.py:{LINE + 1}: target=rclpy.spin(node) calls rclpy.spin at once, and it does not "
        "return before the program ends; write target=rclpy.spin, args=(node,)"
    ]


def test_a_node_that_is_made_after_a_spin(told: Callable[[str], list[str]]) -> None:
    """It is told to make it before."""
    assert told("rclpy.spin(node)\nother = Asker()\nrclpy.spin(other)") == [
        f"late.py:{LINE + 1} comes after rclpy.spin(node), which does not return: Asker is not made before that ends; "
        "make it before, and spin both in one executor"
    ]


@pytest.mark.parametrize(
    "body",
    [
        "rclpy.ok(); rclpy.spin(Asker())",
        "rclpy.spin(node)\nnode.save()\nprint(node.get_name())\nnode.destroy_node()\nrclpy.shutdown()",
        "try:\n  rclpy.spin(node)\nexcept KeyboardInterrupt:\n  node.ask()\nfinally:\n  node.ask()",
        "try:\n  rclpy.spin(node)\nexcept Exception:\n  pass\nnode.ask()",
        "rclpy.spin(node)\nrclpy.shutdown()\nrclpy.init()\nnode.ask()",
        "rclpy.spin(node)\nreturn\nnode.ask()",
        "rclpy.spin(node)\nlambda: None\nunknown.ask()",
        "def end():\n  executor.shutdown()\nexecutor.add_node(node)\nexecutor.spin()\n",
    ],
)
def test_what_may_come_after_a_spin(told: Callable[[str], list[str]], body: str) -> None:
    """What is done at the end is not told."""
    assert told(body) == []


def test_an_executor_that_is_shut_down_elsewhere(tmp_path: Path) -> None:
    """Its spin may return; what its own function does afterwards, and `rclpy.shutdown()`, do not count."""
    file = tmp_path / "one.py"
    file.write_text("def main():\n    executor.spin()\n    executor.shutdown()\ndef end():\n    rclpy.shutdown()\n")
    main = ast.parse(file.read_text()).body[0]
    assert not unreached._may_be_ended(str(file), main)
    file.write_text(file.read_text() + "    executor.shutdown()\n")
    assert unreached._may_be_ended(str(file), main)
