"""Handlers that take the place of a parent's and are for something else."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from graphflow import Node
from graphflow.runtime.mistakes.source.slips import slips

BASE = """\
from graphflow import Node, Subscription, action, service, subscription, task, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts, SetBool
from graphflow.msgs.std_msgs.msg import Int32, String


class Base(Node):
    pose = None

    @subscription(String, "pose")
    async def heard(self, message: String) -> None:
        self.pose = message

    @timer(1.0)
    async def tick(self) -> None:
        print(self.pose)

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response()


class Robot(Base):
"""
HEARD = '@subscription(String, "goal")\nasync def heard(self, message: String) -> None:\n    '
LAST = "if both are meant, give it another name"


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Callable[[str], type[Node]]]:
    """Makes the class `Robot` of a module, a child of `Base`, with these lines in its body."""

    def made(body: str) -> type[Node]:
        file = tmp_path / "overridden_module.py"
        file.write_text(BASE + "".join(f"    {line}\n" for line in body.splitlines()))
        spec = importlib.util.spec_from_file_location("overridden_module", file)
        assert spec is not None
        assert spec.loader is not None
        sys.modules["overridden_module"] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.Robot  # type: ignore[no-any-return]

    yield made
    sys.modules.pop("overridden_module", None)


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (
            HEARD + "self.goal = message",
            "heard on 'goal' replaces heard on 'pose' (overridden_module.py:9), which is no longer received",
        ),
        (
            HEARD.replace("String", "Int32").replace("goal", "pose") + "print(message)",
            "heard on 'pose' of Int32 replaces heard on 'pose' of String (overridden_module.py:9), "
            "which is no longer received",
        ),
        (
            '@subscription(String, "goal")\nasync def tick(self, message: String) -> None: ...',
            "tick on 'goal' replaces tick (a timer) (overridden_module.py:13), which no longer runs",
        ),
        (
            '@service(AddTwoInts, "sum")\nasync def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response: ...',
            "add on 'sum' replaces add on 'add' (overridden_module.py:17), which is no longer answered",
        ),
    ],
)
def test_a_handler_that_is_lost(robot: Callable[[str], type[Node]], body: str, told: str) -> None:
    """The report has the lines of both methods."""
    [text] = slips(robot(body))  # type: ignore[arg-type] # a class can be hashed
    assert text.partition("overridden_module.py:24: ")[2] == f"{told}; {LAST}"


@pytest.mark.parametrize(
    "body",
    [
        HEARD.replace("goal", "pose") + "self.goal = message",
        HEARD + "self.goal = message\n    await super().heard(message)",
        HEARD + "self.goal = message\n    await Base.heard(self, message)",
        HEARD + "self.pose = message",
        "async def heard(self, message: String) -> None:\n    self.goal = message",
        "@timer(0.5)\nasync def tick(self) -> None: ...",
        'poses = Subscription(String, "pose")\n' + HEARD + "self.goal = message",
        '@subscription(String, "pose")\nasync def other(self, message: String) -> None: ...\n' + HEARD + "print(1)",
        HEARD.replace("heard", "goal_heard") + "self.goal = message",
    ],
)
def test_what_is_meant(robot: Callable[[str], type[Node]], body: str) -> None:
    """The same topic, a call of the parent's, the same work from another topic, or another handler for the topic."""
    assert slips(robot(body)) == ()  # type: ignore[arg-type] # a class can be hashed
