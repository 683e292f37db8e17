"""Slips in a class that Python runs without an error."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow import DeclarationError, Node
from graphflow.runtime.mistakes.source.slips import slips
from graphflow.testing import Graph

HEAD = """\
from graphflow import Node, Param, Publisher, subscription, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import Bool, Int32, String


class Robot(Node):
    rate = Param(1.0)
    out = Publisher(Int32, "out")

"""


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[type[Node]]:
    """Makes the class `Robot` of a module with these lines in its body."""

    def made(body: str) -> type[Node]:
        file = tmp_path / "slip_module.py"
        file.write_text(HEAD + "".join(f"    {line}\n" for line in body.splitlines()))
        spec = importlib.util.spec_from_file_location("slip_module", file)
        assert spec is not None
        assert spec.loader is not None
        sys.modules["slip_module"] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.Robot  # type: ignore[no-any-return]

    yield made  # type: ignore[misc]
    sys.modules.pop("slip_module", None)


LOOKS = "nothing calls Robot.{}, which looks like a handler: declare it, as with {} above it"
SUBSCRIPTION, SERVICE = '@subscription(Type, "topic")', '@service(Type, "name")'


def slip_of(robot: object, body: str) -> str:
    """Return the only sentence about a class with these lines, without its place."""
    [text] = slips(robot(body))  # type: ignore[operator]
    place, _, rest = text.partition(": ")
    assert place.partition("slip_module.py:")[2].isdigit()
    return rest


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("async def heard(self, message: String) -> None: ...", LOOKS.format("heard", SUBSCRIPTION)),
        (
            "async def heard(self, message: String) -> None:\n    self.log.info('heard')",
            LOOKS.format("heard", SUBSCRIPTION),
        ),
        ("def add(self, request: AddTwoInts.Request): ...", LOOKS.format("add", SERVICE)),
        ("def on_pose(self, message): ...", LOOKS.format("on_pose", SUBSCRIPTION)),
        ("def on_strat(self): ...", "nothing calls Robot.on_strat; did you mean on_start?"),
        ("def on_stop(self): ...", "nothing calls Robot.on_stop; did you mean on_shutdown?"),
        (
            "async def on_configure(self): ...",
            "nothing calls Robot.on_configure; derive Robot from LifecycleNode, whose nodes are configured",
        ),
        ("def timer_callback(self): ...", LOOKS.format("timer_callback", "@timer(1.0)")),
    ],
)
def test_methods_that_nothing_calls(robot: object, body: str, told: str) -> None:
    """With what would call it."""
    assert slip_of(robot, body).startswith(told)


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (
            "is_on = False\n@subscription(Bool, 't')\ndef heard(self, m: Bool) -> None:\n    self.is_on = m",
            "m is the whole message, which counts as true; write self.is_on = m.data",
        ),
        (
            "def work(self):\n    m = String()\n    m.dat = 'x'\n    return m",
            "String has no field 'dat'; did you mean 'data'?",
        ),
        (
            "@subscription(String, 't')\ndef heard(self, m: String) -> None:\n    m.dat = 'x'",
            "String has no field 'dat'",
        ),
        ("def work(self):\n    m = Int32()\n    m.data = 'x'\n    return m", "Int32.data: expected int32, got 'x'"),
        (
            "def work(self):\n    m = Twist()\n    m.linear = 3\n    return m",
            "Twist.linear: expected geometry_msgs/msg/Vector3, got 3",
        ),
    ],
)
def test_messages(robot: object, body: str, told: str) -> None:
    """Set to what they cannot hold, or taken for their field."""
    assert slip_of(robot, body).startswith(told)


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (
            "def work(self):\n    self.x = 1\ndef go(self):\n    Thread(target=self.work())",
            "target=self.work() calls work at once, and passes on its result, None; write target=self.work",
        ),
        (
            "def work(self):\n    self.shutdown",
            "self.shutdown without parentheses calls nothing; write: self.shutdown()",
        ),
        (
            "tags = Param(['a'])\ndef work(self):\n    self.tags.append('b')",
            "self.tags.append('b') changes a parameter's list without its checks, and no tool sees it; "
            "set a new one, as in self.tags = [*self.tags, ...]",
        ),
        (
            "tags = Param(['a'])\ndef work(self):\n    self.tags[0] = 'b'",
            "self.tags[0] changes a parameter's list without its checks",
        ),
        *(
            (f"def work(self):\n    {owner}.rate = 2.0", f"{owner}.rate replaces what the class declares")
            for owner in ("Robot", "type(self)")
        ),
    ],
)
def test_other_slips(robot: object, body: str, told: str) -> None:
    """Each with its line."""
    assert slip_of(robot, body).startswith(told)


@pytest.mark.parametrize(
    "body",
    [
        "async def on_start(self) -> None: ...",
        "@timer(1.0)\nasync def tick(self) -> None: ...",
        "def on_pose(self, m: String) -> None: ...\nasync def on_start(self) -> None:\n    self.use(self.on_pose)",
        "is_on = None\n@subscription(Bool, 't')\ndef heard(self, m: Bool) -> None:\n    self.is_on = m",
        "def work(self, other):\n    Robot.times = 2\n    other.rate = 2.0\n    self.rate = 2.0",
        "def helper(self, pose): ...",
    ],
)
def test_what_is_no_slip(robot: object, body: str) -> None:
    """Hooks, methods that are passed on, attributes that are read, and flags of no bool."""
    assert slips(robot(body)) == ()  # type: ignore[operator]


@pytest.mark.parametrize(
    "body",
    [
        "def work(self, m):\n    m.dat = 'x'",
        "def work(self):\n    m = String()\n    m.data = 'x'\n    return m",
        "def work(self):\n    m = String()\n    m = object()\n    m.dat = 'x'\n    return m",
        "def work(self, messages):\n    m = String()\n    for m in messages:\n        m.dat = 'x'",
        "def work(self):\n    m = self.port.inbox.read()\n    m.dat = 'x'",
    ],
)
def test_messages_of_unknown_types(robot: object, body: str) -> None:
    """Their names may stand for anything."""
    assert slips(robot(body)) == ()  # type: ignore[operator]


@pytest.mark.parametrize("name", ["name", "context", "clock", "group", "log"])
def test_what_every_node_has_cannot_be_set(robot: object, name: str) -> None:
    """The line is reported before a node is made."""
    cls = robot(f"def work(self):\n    self.{name} = 'bob'")  # type: ignore[operator]
    with pytest.raises(
        DeclarationError, match=rf"slip_module\.py:12: every node has self\.{name}, which cannot be set"
    ):
        cls.interface()


async def test_a_node_tells_them_when_it_starts(graph: Graph, robot: object, caplog: pytest.LogCaptureFixture) -> None:
    """Once for each start, as warnings."""
    await graph.start(robot("def on_pose(self, message): ...")())  # type: ignore[operator]
    assert [record.levelname for record in caplog.records if "nothing calls Robot.on_pose" in record.message] == [
        "WARNING"
    ]


def test_a_method_that_another_module_of_the_project_calls(robot: object, tmp_path: Path) -> None:
    """As a child's does, or that of the program."""
    cls = robot("def on_pose(self, message): ...")  # type: ignore[operator]
    other = tmp_path / "slip_other.py"
    other.write_text("def use(robot):\n    robot.on_pose(1)\n")
    spec = importlib.util.spec_from_file_location("slip_other", other)
    assert spec is not None
    sys.modules["slip_other"] = importlib.util.module_from_spec(spec)
    try:
        assert slips(cls) == ()
    finally:
        del sys.modules["slip_other"]


def test_an_attribute_that_another_module_of_the_project_reads(robot: object, tmp_path: Path) -> None:
    """As a test does."""
    cls = robot("def work(self):\n    self.rat = 2.0")  # type: ignore[operator]
    other = tmp_path / "slip_test.py"
    other.write_text("def use(robot):\n    assert robot.rat == 2.0\n")
    spec = importlib.util.spec_from_file_location("slip_test", other)
    assert spec is not None
    sys.modules["slip_test"] = importlib.util.module_from_spec(spec)
    try:
        assert slips(cls) == ()
    finally:
        del sys.modules["slip_test"]


def test_a_flag_that_another_module_of_the_project_sets(robot: object, tmp_path: Path) -> None:
    """As the program does; without it, the loop has no end."""
    body = "done = False\nasync def go(self):\n    while not self.done:\n        await self.clock.sleep(0.1)"
    [text] = slips(robot(body))  # type: ignore[operator]
    assert "this loop waits for self.done" in text
    other = tmp_path / "slip_program.py"
    other.write_text("def end(robot):\n    robot.done = True\n")
    spec = importlib.util.spec_from_file_location("slip_program", other)
    assert spec is not None
    sys.modules["slip_program"] = importlib.util.module_from_spec(spec)
    try:
        assert slips(robot(body)) == ()  # type: ignore[operator]
    finally:
        del sys.modules["slip_program"]


def test_nothing_of_the_users_runs(robot: object) -> None:
    """Names are resolved without evaluating properties."""
    cls = robot(
        "def work(self):\n    data = port.inbox.read()\n    data.x = 1\n"
        "def heard(self, message: 'port.Type') -> None: ..."
    )  # type: ignore[operator]

    class Port:
        @property
        def inbox(self) -> object:
            raise OSError("the port is not open")

        Type = inbox

    vars(sys.modules["slip_module"])["port"] = Port()
    assert slips(cls) == ()
