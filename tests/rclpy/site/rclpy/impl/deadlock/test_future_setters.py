"""Who may end the future of an answer."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from rclpy.impl.deadlock.future_setters import may_be_ended, programs_files
from rclpy.node import Node
from rclpy.task import Future

HEAD = "from rclpy.node import Node\n\nclass Asker(Node):\n    def go(self, given):\n        "


@pytest.fixture
def load(tmp_path: Path, request: pytest.FixtureRequest) -> Any:
    """Makes a module of a text; returns it and its file."""

    def make(text: str) -> tuple[ModuleType, str]:
        file = tmp_path / f"m{len(list(tmp_path.iterdir()))}.py"
        file.write_text(text)
        module = ModuleType(f"enders_{file.stem}")
        module.__file__ = str(file)
        sys.modules[module.__name__] = module
        request.addfinalizer(lambda: sys.modules.pop(module.__name__))
        exec(compile(text, str(file), "exec"), module.__dict__)
        return module, str(file)

    return make


@pytest.mark.parametrize(
    ("line", "may"),
    [
        ("given.cancel()", True),
        ("Thread(target=given.set_result, args=(1,))", True),
        ("self.asked.set_exception(OSError())", True),
        ("self.other.set_result(1)", False),
        ("self.timer.cancel()", False),
        ("self.unknown.cancel()", True),
        ("timer.cancel()", False),
        ("t = self.create_timer(1, print); t.cancel()", False),
        ("t = self.make(); t.cancel()", True),
        ("done = Future(); done.set_result(1)", False),
        ("self.late: Timer = self.create_timer(1, print); self.late.cancel()", False),
        ("self.late = None; self.late = self.client.call_async(given); self.late.cancel()", True),
        ("given.done()", False),
    ],
)
def test_code_that_cancels_or_sets(node: Node, load: Any, line: str, may: bool) -> None:
    """Unless what it ends is known to be something else."""
    module, file = load(HEAD + line)
    asker = module.Asker("asker")
    asker.asked, asker.other, asker.timer = Future(), Future(), asker.create_timer(1.0, print)
    assert may_be_ended(asker.asked, [asker], [file]) is may
    assert not may_be_ended(asker.asked, [asker], [])


def test_code_of_nodes_that_are_not_there(node: Node, load: Any) -> None:
    """Ends nothing; that of other classes may."""
    module, file = load(f"{HEAD}pass\n\nclass Other(Asker):\n    def end(self, future):\n        future.cancel()\n")
    future: Future[int] = Future()
    assert not may_be_ended(future, [module.Asker("asker")], [file])
    assert may_be_ended(future, [module.Other("other")], [file])
    module, file = load(f"{HEAD}pass\n\nclass Watchdog:\n    def end(self, future):\n        future.cancel()\n")
    assert may_be_ended(future, [module.Asker("third")], [file])


def test_a_file_that_cannot_be_read_may_do_anything(node: Node) -> None:
    """As far as anybody knows."""
    assert may_be_ended(Future(), [node], ["/no/such/file.py"])


def test_the_programs_files_are_those_of_its_modules(load: Any) -> None:
    """What is installed is not among them, nor is graphflow."""
    _, file = load("")
    files = programs_files()
    assert file in files
    assert not [f for f in files if "site-packages" in f or "graphflow/wire" in f]
