"""What loops poll, and what changes it."""

from __future__ import annotations

import ast
import textwrap
from pathlib import Path

import pytest

from graphflow.analysis.rclpy_check import findings_in, unfollowed_in
from graphflow.analysis.rclpy_flags import Changers, Polled, changers, polled, written_from_outside

NODE = """
import rclpy, threading, time
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup

class Waiter(Node):
    def __init__(self):
        super().__init__("waiter")
        self.there, self.event = False, None
        self.arrived = threading.Event()
        self.group = MutuallyExclusiveCallbackGroup()
        self.create_timer(1.0, self.tick{timer})
        self.create_subscription(Bool, "there", self.on_there, 10)
        {init}

    def tick(self):
        {tick}

    def on_there(self, message):
        {sets}

    def is_done(self):
        return self.there is True

    def keep(self, value):
        self.{kept} = value

def main():
    {spin}
"""
POLL = "while not self.there: time.sleep(0.1)"
SETS = "self.there = message.data"
POOL = "executor = MultiThreadedExecutor(); executor.add_node(Waiter()); executor.spin()"


def file(
    tmp_path: Path,
    tick: str = POLL,
    sets: str = SETS,
    *,
    timer: str = "",
    init: str = "pass",
    spin: str = "rclpy.spin(Waiter())",
) -> Path:
    made = tmp_path / "waiter.py"
    kept = "there" if "keep" in sets + init else "kept"
    text = NODE.format(tick=tick, sets=sets, timer=timer, init=init, spin=spin, kept=kept)
    made.write_text(text, encoding="utf-8")
    return made


@pytest.mark.parametrize(
    ("tick", "sets"),
    [
        (POLL, SETS),
        ("while rclpy.ok() and not self.there: time.sleep(0.1)", SETS),
        ("while not self.is_done(): time.sleep(0.1)", "self.keep(message.data)"),
        ("while not self.there: pass", SETS),
        ("while not self.there: self.pub.publish(Twist())", SETS),
        ("while not self.there: print('waits')", SETS),
        ("while not self.there: self.get_logger().info('waits')", SETS),
        ("while not self.there: rclpy.spin_once(self)", SETS),
        ("self.arrived.wait()", "self.arrived.set()"),
    ],
)
@pytest.mark.parametrize("spin", ["rclpy.spin(Waiter())", POOL])
def test_what_another_callback_of_the_group_sets(tmp_path: Path, tick: str, sets: str, spin: str) -> None:
    """It is found, with the callback that is kept out, whichever way that sets it."""
    made = file(tmp_path, tick, sets, spin=spin)
    [way] = findings_in(made)

    assert way.grade == "IF THIS BRANCH RUNS"
    assert made.read_text("utf-8").splitlines()[way.place.line - 1].strip() == tick
    text = str(way)
    assert "timer tick waits in" in text
    assert "and on_there, which sets self." in text
    assert "needs the default callback group, which tick holds until it returns" in text
    assert "return instead of waiting, and go on in on_there; or make tick with callback_group=Mutually" in text
    assert unfollowed_in(made) == []


def test_a_group_of_its_own_is_enough_with_threads_only(tmp_path: Path) -> None:
    """With one thread, that is what the other callback lacks."""
    [way] = findings_in(file(tmp_path, timer=", callback_group=self.group"))
    assert "needs a thread that spins, and the only one is in tick" in str(way)
    made = file(tmp_path, timer=", callback_group=self.group", spin=POOL)
    assert (findings_in(made), unfollowed_in(made)) == ([], [])


@pytest.mark.parametrize(
    ("tick", "sets", "init"),
    [
        (POLL, "pass", "pass"),
        (POLL, SETS, "threading.Thread(target=self.keep, args=(1,)).start()"),
        (POLL, SETS, "self.create_timer(1.0, lambda: self.keep(1))"),
        ("while not self.there or self.other(): time.sleep(0.1)", SETS, "pass"),
        ("while not self.there:\n            time.sleep(0.1)\n            if self.x: break", SETS, "pass"),
        ("while not self.there: self.there = look(); time.sleep(0.1)", SETS, "pass"),
        ("self.arrived.wait()", "give(self.arrived)", "pass"),
        (POLL, SETS + "\n        message.node.there = True", "pass"),
    ],
)
def test_what_is_not_known(tmp_path: Path, tick: str, sets: str, init: str) -> None:
    """Nothing is found, and it is said where nothing was looked into."""
    made = file(tmp_path, tick, sets, init=init)
    assert findings_in(made) == []
    [place] = unfollowed_in(made)
    assert made.read_text("utf-8").splitlines()[place.line - 1].strip() == tick.partition("\n")[0]


@pytest.mark.parametrize(
    "tick",
    [
        "while not self.there and time.monotonic() < end: time.sleep(0.1)",
        "self.arrived.wait(1.0)",
        "while not self.there: work()",
        "while not self.there: self.keep(1)",
        "while self.queue: self.queue.pop()",
    ],
)
def test_what_ends_by_itself_or_works(tmp_path: Path, tick: str) -> None:
    """It is no wait for anything else."""
    made = file(tmp_path, tick)
    assert (findings_in(made), unfollowed_in(made)) == ([], [])


def test_the_parts(tmp_path: Path) -> None:
    """A loop's attributes, what changes them, and what is written from outside."""
    tree = ast.parse(
        textwrap.dedent("""
        def wait(self):
            while not self.pose.x: sleep(1)
        def on_pose(self, message):
            self.pose.x = 1.0
        def later(self):
            self.client.call_async(1).add_done_callback(self.done)
        def done(self, future):
            self.pose = future.result()
        other.pose.y = 2.0
        """)
    )
    methods = {f.name: f for f in tree.body if isinstance(f, ast.FunctionDef)}
    [loop] = [node for node in ast.walk(tree) if isinstance(node, ast.While)]

    assert polled(loop, methods) == Polled("`while not self.pose.x`", frozenset({"pose"}), gives_up=False)
    found = changers(frozenset({"pose"}), methods, frozenset({"wait", "on_pose"}))
    assert found == Changers(frozenset({"on_pose", "done"}), is_known=True)
    assert not changers(frozenset({"pose"}), methods, frozenset({"wait"})).is_known
    assert written_from_outside(tree) == {"y"}


HELPER = """
class Waiter:
    def __init__(self, node):
        self.m = None
        node.create_subscription(String, "x", self.got, 10)
    def got(self, m): self.m = m
    def wait(self):
        while self.m is None: time.sleep(0.02)
class P(Node):
    def __init__(self):
        super().__init__("p")
        self.w = Waiter(self)
        {}
"""


@pytest.mark.parametrize(
    ("use", "lines"),
    [("self.create_timer(0.5, self.w.wait)", [8]), ("Thread(target=self.w.wait).start()", [])],
)
def test_loops_of_other_classes(tmp_path: Path, use: str, lines: list[int]) -> None:
    """They are not followed, and the places are told; those of threads keep no callback waiting."""
    made = tmp_path / "helper.py"
    made.write_text(HELPER.format(use))
    assert [place.line for place in unfollowed_in(made)] == lines
