"""Methods that a line names and does not call."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

import rclpy
from graphflow.analysis.mistakes.calls.hidden_logs import HIDDEN
from rclpy.impl.deadlock import waiting
from rclpy.impl.logging_severity import LoggingSeverity
from rclpy.impl.mistakes.uncalled import Uncalled
from rclpy.node import Node
from tests.rclpy.conftest import Spinner

SOURCE = """
def tick(timer=None):
    timer.cancel
    timer.period
    timer.state == "on"
    Thread(target=work())

def work():
    print("works")
"""


TWICE = """from rclpy.node import Node
from std_msgs.msg import Int32
class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.a = self.create_subscription(Int32, "a", self.heard, 10)
        self.b = self.create_subscription(Int32, "b", self.heard, 10)
        self.pub = self.create_publisher(Int32, "c", 10)
    def heard(self, message):
        print(message.data)

    def heard(self, message):
        print(message.r)
"""


@pytest.mark.parametrize("is_spun", [True, False])
def test_a_method_without_parentheses(
    node: Node,
    spin: Spinner,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    is_spun: bool,
) -> None:
    """It is told once for each line, when the node is spun, or else when it leaves."""
    monkeypatch.setattr(waiting, "LOOK_EVERY", 0.02)
    space: dict[str, Any] = {}
    file = tmp_path / "lamp.py"
    file.write_text(SOURCE)
    exec(compile(SOURCE, str(file), "exec"), space)
    lamp = Node("lamp")
    timer = lamp.create_timer(100.0, space["tick"])
    timer.callback = space["tick"]
    if is_spun:
        rclpy.spin_once(lamp, timeout_sec=0.0)
        spin(lambda: "parentheses" in caplog.text)
    rclpy.shutdown()
    found = [record.getMessage() for record in caplog.records if record.getMessage().startswith("lamp.py")]
    assert found == [
        "lamp.py:3: timer.cancel without parentheses calls nothing; write: timer.cancel()",
        "lamp.py:5: timer.state == 'on' compares without effect; write = to set it",
        "lamp.py:6: target=work() calls work at once, and passes on its result, None; write target=work",
    ]


@pytest.mark.parametrize(("ended_by", "is_told"), [(ValueError(), False), (KeyboardInterrupt(), True)])
def test_a_program_that_an_error_ends(
    node: Node,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    ended_by: BaseException,
    is_told: bool,
) -> None:
    """The error is its last word; Ctrl-C is none."""
    monkeypatch.setattr(sys, "last_value", ended_by, raising=False)
    space: dict[str, Any] = {}
    file = tmp_path / "lamp.py"
    file.write_text(SOURCE)
    exec(compile(SOURCE, str(file), "exec"), space)
    Node("lamp").create_timer(100.0, space["tick"])
    rclpy.shutdown()
    assert ("parentheses" in caplog.text) is is_told


def test_an_error_of_a_method_that_is_replaced(
    node: Node, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The remark on the method in which it was raised is told, since that is the cause."""
    file, space = tmp_path / "lamp.py", {"__name__": "lamp"}
    file.write_text(TWICE)
    exec(compile(TWICE, str(file), "exec"), space)
    made: Any = space["Lamp"]
    lamp = made()
    with pytest.raises(AttributeError) as caught:
        lamp.heard(1)
    monkeypatch.setattr(sys, "last_value", caught.value, raising=False)
    rclpy.shutdown()
    [text] = [record.getMessage() for record in caplog.records if record.getMessage().startswith("lamp.py")]
    assert text.startswith("lamp.py:9: Lamp has another 'heard' in line 12, which replaces this one; rename")


def test_nodes_that_left(node: Node) -> None:
    """They are forgotten."""
    watch = Uncalled(node._graphflow.life)
    for _ in range(3):
        Node("lamp").destroy_node()
    assert watch._nodes == set()


@pytest.mark.parametrize("is_shown", [True, False])
def test_a_log_that_is_shown(
    node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture, tmp_path: Path, is_shown: bool
) -> None:
    """A hint to the log level is left out where the level is given."""
    source = "def tick():\n    node.get_logger().debug('on')\n\ndef main():\n    rclpy.spin(node)\n"
    file = tmp_path / "lamp.py"
    file.write_text(source)
    space: dict[str, Any] = {"node": node}
    exec(compile(source, str(file), "exec"), space)
    node.create_timer(100.0, space["tick"])
    node.get_logger().set_level(LoggingSeverity.DEBUG if is_shown else LoggingSeverity.INFO)
    rclpy.spin_once(node, timeout_sec=0.0)
    rclpy.shutdown()
    assert (f"lamp.py:2: {HIDDEN}" in caplog.messages) is not is_shown
