"""Deadlocks that the source of rclpy nodes tells of."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.analysis import rclpy_check
from graphflow.analysis.rclpy_check import files_in, findings_in

HEAD = """
import rclpy
from rclpy.node import Node
from rclpy.executors import MultiThreadedExecutor
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.action import ActionClient, ActionServer

class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        self.group = MutuallyExclusiveCallbackGroup()
        self.client = self.create_client(Trigger, "ask"{client})
        self.goals = ActionClient(self, Fibonacci, "count")
        self.timer = self.create_timer(1.0, self.tick{timer})
        self.server = self.create_service(Trigger, "own", self.on_own)
        self.actions = ActionServer(self, Fibonacci, "act", self.execute)
        {init}

    {tick}

    def on_own(self, request, response):
        {own}
        return response

    def execute(self, goal):
        {execute}
        return Fibonacci.Result()

    def helper(self):
        return self.client.call(Trigger.Request())

def main():
    rclpy.init()
    {spin}
"""
POOL = "executor = MultiThreadedExecutor(); executor.add_node(Asker()); executor.spin()"
TICK = "def tick(self):\n        "


def found(
    tmp_path: Path,
    *,
    client: str = "",
    timer: str = "",
    tick: str = TICK + "pass",
    own: str = "pass",
    execute: str = "pass",
    init: str = "pass",
    spin: str = "rclpy.spin(Asker())",
) -> list[tuple[str, str]]:
    """The grades of what is found, and the source lines."""
    text = HEAD.format(client=client, timer=timer, tick=tick, own=own, execute=execute, init=init, spin=spin)
    file = tmp_path / "asker.py"
    file.write_text(text)
    lines = text.splitlines()
    return [(way.grade, lines[way.place.line - 1].strip()) for way in findings_in(file)]


CALL = "self.client.call(Trigger.Request())"
ASYNC = "future = self.client.call_async(Trigger.Request())\n        "


GROUP = ", callback_group=self.group"
OWN = "callback_group=MutuallyExclusiveCallbackGroup()"
AWAIT = "async def tick(self):\n        await self.client.call_async(Trigger.Request())"


@pytest.mark.parametrize(
    "body",
    [
        CALL,
        "self.goals.send_goal(Fibonacci.Goal())",
        ASYNC + "rclpy.spin_until_future_complete(self, future)",
        ASYNC + "while not future.done(): time.sleep(0.1)",
        ASYNC + "while rclpy.ok() and not future.done(): rclpy.spin_once(self)",
    ],
)
@pytest.mark.parametrize("spin", ["rclpy.spin(Asker())", POOL])
def test_an_answer_that_needs_the_callbacks_own_group(tmp_path: Path, body: str, spin: str) -> None:
    """It is certain, with any executor."""
    assert found(tmp_path, tick=TICK + body, spin=spin) == [("CERTAIN", body.rpartition("\n")[2].strip())]


def test_a_group_of_its_own_is_enough_with_threads_only(tmp_path: Path) -> None:
    """One thread is held by who waits."""
    own = ", callback_group=self.group"
    assert found(tmp_path, tick=TICK + CALL, client=own) == [("CERTAIN", CALL)]
    assert found(tmp_path, tick=TICK + CALL, client=own, spin=POOL) == []
    assert found(tmp_path, tick=TICK + CALL, timer=own, spin=POOL) == []
    assert found(tmp_path, tick=TICK + CALL, timer=own, client=own, spin=POOL) == [("CERTAIN", CALL)]
    reentrant = ", callback_group=ReentrantCallbackGroup()"
    assert found(tmp_path, tick=TICK + CALL, timer=reentrant, client=reentrant, spin=POOL) == []


@pytest.mark.parametrize(
    ("settings", "needs", "change"),
    [
        (
            {"name": "own"},
            "answer needs the default callback group",
            f"make tick with {OWN}, and ",
        ),
        ({"name": "own", "client": GROUP}, "server on_own needs the default", f"make tick with {OWN}, and "),
        ({"name": "own", "tick": AWAIT}, "answer needs the default", f"make tick with {OWN}"),
        (
            {"tick": TICK + "self.goals.send_goal(Fibonacci.Goal())"},
            "answer needs the default",
            f"make tick with {OWN}",
        ),
    ],
)
def test_an_answer_that_the_node_itself_would_give(
    tmp_path: Path, settings: dict[str, str], needs: str, change: str
) -> None:
    """The change frees its server as well."""
    settings = {"tick": TICK + CALL, "client": "", **settings}
    text = HEAD.replace('"ask"', f'"{settings.pop("name", "ask")}"').replace('"count"', '"act"')
    rest = dict.fromkeys(("timer", "init", "own", "execute"), "pass") | {"timer": "", "spin": POOL}
    (tmp_path / "asker.py").write_text(text.format(**rest, **settings))
    [way] = findings_in(tmp_path / "asker.py")
    assert f"whose {needs}" in str(way)
    assert change in str(way)
    later = "send_goal_async(goal)" if "send_goal" in settings["tick"] else "call_async(request)"
    assert f"use {later} and add_done_callback(...)" in str(way) or "await" in settings["tick"]


ITSELF = """\
class Square(Node):
    def __init__(self):
        super().__init__('square')
        self.create_subscription(Pose, 'pose', self.on_pose, 10)
    def on_pose(self, msg):
        self.pose = msg
        while self.pose.x < 8.0:
            time.sleep(0.1)
rclpy.spin(Square())
"""


def test_a_loop_that_never_runs(tmp_path: Path) -> None:
    """The method in its condition is not called, which another check tells; without the `not`, it runs for ever."""
    assert found(tmp_path, init="while not self.client.wait_for_service: pass") == []
    loop = "while self.client.wait_for_service: pass"
    assert found(tmp_path, init=loop) == [("IF THIS BRANCH RUNS", loop)]


def test_a_callback_that_waits_for_its_next_call(tmp_path: Path) -> None:
    """No group and no thread ends that: the next call would wait as well."""
    (tmp_path / "square.py").write_text(ITSELF)
    [way] = findings_in(tmp_path / "square.py")
    assert str(way).endswith(
        "which on_pose holds until it returns: return instead of waiting, and go on in its next call"
    )


def test_a_coroutine_gives_back_its_thread_and_keeps_its_group(tmp_path: Path) -> None:
    """So the client needs another one."""
    tick = "async def tick(self):\n        await self.client.call_async(Trigger.Request())"
    assert [grade for grade, _ in found(tmp_path, tick=tick)] == ["CERTAIN"]
    assert found(tmp_path, tick=tick, client=", callback_group=ReentrantCallbackGroup()") == []
    tick = "async def tick(self):\n        " + ASYNC + "await future"
    assert found(tmp_path, tick=tick) == [("CERTAIN", "await future")]


def test_a_rate_in_a_callback(tmp_path: Path) -> None:
    """Its tick needs a thread, and no group."""
    body = "rate = self.create_rate(10)\n        rate.sleep()"
    assert found(tmp_path, tick=TICK + body) == [("CERTAIN", "rate.sleep()")]
    assert found(tmp_path, tick=TICK + body, spin=POOL) == []
    made = "self.pace = self.create_rate(10)"
    assert found(tmp_path, init=made, tick=TICK + "self.pace.sleep()") == [("CERTAIN", "self.pace.sleep()")]
    assert found(tmp_path, tick=TICK + "self.rate.sleep()") == []  # whatever that is


def test_bodies_of_goals_are_in_no_group(tmp_path: Path) -> None:
    """But in the only thread."""
    assert found(tmp_path, execute=CALL) == [("CERTAIN", CALL)]
    assert found(tmp_path, execute=CALL, spin=POOL) == []


def test_what_a_callback_calls_belongs_to_it(tmp_path: Path) -> None:
    """The line is that which waits; in a branch, it may not come to that."""
    waiting = ("CERTAIN", "return " + CALL)
    assert found(tmp_path, own="self.helper()") == [waiting]
    assert found(tmp_path, own="if request.data: self.helper()") == [("IF THIS BRANCH RUNS", waiting[1])]


def test_nobody_spins_a_node_that_is_being_made(tmp_path: Path) -> None:
    """Unless it does so itself."""
    assert found(tmp_path, init=CALL) == [("CERTAIN", CALL)]
    assert found(tmp_path, init=ASYNC + "rclpy.spin_until_future_complete(self, future)") == []


@pytest.mark.parametrize(
    "body",
    [
        "self.client.call_async(Trigger.Request()).add_done_callback(self.helper)",
        "self.client.call_async(Trigger.Request()).add_done_callback(lambda f: self.client.call(1))",
        "other.client.call(Trigger.Request())",
        "self.notes.call(1)",
        "time.sleep(1)",
        "while not self.flag: pass",
    ],
)
def test_what_does_not_wait(tmp_path: Path, body: str) -> None:
    """Or waits for something that is not known."""
    assert found(tmp_path, tick=TICK + body) == []


def test_parents_in_the_same_file_count(tmp_path: Path) -> None:
    """What they register calls what the child has."""
    file = tmp_path / "a.py"
    file.write_text(
        "class Base(Node):\n    def __init__(self):\n        self.client = self.create_client(T, 'x')\n"
        "        self.create_timer(1, self.fire)\n    def fire(self):\n        self.tick()\n"
        "class Child(Base):\n    def tick(self):\n        self.client.call(1)\n"
    )
    [way] = findings_in(tmp_path)
    assert way.place.line == 9
    assert "the default callback group, which fire holds until it returns" in way.text


def test_folders_are_read_whole_but_for_what_is_built(tmp_path: Path) -> None:
    """And what is no Python is passed over."""
    source = (
        "class A(Node):\n    def __init__(self):\n        self.c = self.create_client(T, 'x')\n        self.c.call(1)\n"
    )
    for name in ("src/a.py", "build/b.py", ".hidden/c.py"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(source)
    (tmp_path / "src/broken.py").write_text("def (")
    (tmp_path / "src/bytes.py").write_bytes(b"\xff\xfe\x00")
    assert [Path(way.place.file).name for way in findings_in(tmp_path)] == ["a.py"]


CERTAIN = [("CERTAIN", "self.client.call(Trigger.Request())")]
OTHERS = ", callback_group=ReentrantCallbackGroup()"


@pytest.mark.parametrize(
    "spin",
    [
        "from rclpy.executors import MultiThreadedExecutor as Pool; executor = Pool(); executor.add_node(Asker())",
        "executor = lab.PriorityExecutor(); executor.add_node(Asker()); executor.spin()",
    ],
)
def test_executors_that_may_have_more_threads(tmp_path: Path, spin: str) -> None:
    """Under other names, or of the program's own: nothing is said of threads."""
    tick = f"{TICK}self.client.call(Trigger.Request())"
    assert found(tmp_path, tick=tick, client=OTHERS) == CERTAIN
    assert found(tmp_path, tick=tick, client=OTHERS, spin=spin) == []


def test_another_server_may_answer(tmp_path: Path) -> None:
    """One of the same name, in the same file."""
    client, tick = OTHERS, f"{TICK}self.client.call(Trigger.Request())"
    serves = 'self.create_service(Trigger, "ask", self.on_own)'
    assert found(tmp_path, tick=tick, client=client, init=serves, spin=POOL) == CERTAIN
    other = f'{serves}\n        rclpy.create_node("other").create_service(Trigger, "ask", print)'
    assert found(tmp_path, tick=tick, client=client, init=other, spin=POOL) == []


@pytest.mark.parametrize("given", ["Timer(3.0, future.cancel).start()", "self.pending[future] = 1", "watch(future)"])
def test_a_future_that_others_may_end(tmp_path: Path, given: str) -> None:
    """Is not waited for in vain."""
    lines = ["future = self.client.call_async(Trigger.Request())", "rclpy.spin_until_future_complete(self, future)"]
    assert len(found(tmp_path, tick=TICK + "\n        ".join(lines))) == 1
    assert found(tmp_path, tick=TICK + "\n        ".join([lines[0], given, lines[1]])) == []


def test_a_folder_of_many_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only so many are read."""
    monkeypatch.setattr(rclpy_check, "FILES_BOUND", 2)
    for name in "abc":
        (tmp_path / f"{name}.py").write_text("")
    assert [file.name for file in files_in(tmp_path)] == ["a.py", "b.py"]


def test_a_constructor_that_waits_for_a_message(tmp_path: Path) -> None:
    """There is no request in it: it goes on in a callback."""
    file = tmp_path / "a.py"
    file.write_text(
        "class A(Node):\n    def __init__(self):\n        self.create_subscription(T, 'x', self.on_x, 10)\n"
        "        self.x = None\n        while self.x is None:\n            time.sleep(0.1)\n\n"
        "    def on_x(self, msg):\n        self.x = msg\n"
    )
    [found] = findings_in(file)
    assert found.text.endswith("before it is made: go on in a timer, or in the callback that it waits for")
