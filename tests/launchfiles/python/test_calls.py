"""Code of a launch file that makes actions."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from graphflow.launchfiles.python import actions as converter
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import Context, RecordedCall


@pytest.fixture(autouse=True)
def started() -> Iterator[None]:
    """The file is about to be started, with two arguments."""
    RECORDING.values, RECORDING.set = {"n": "2", "robots": "{name: a}; {name: b, x: 1.5};"}, {}
    yield
    RECORDING.values, RECORDING.set, RECORDING.problems = None, {}, []


def actions(described: object) -> list[dict[str, Any]]:
    return list(converter.actions(described))


def said(kind: str, /, *args: Any, **kwargs: Any) -> RecordedCall:
    made: RecordedCall = type(kind, (RecordedCall,), {"kind": kind})(*args, **kwargs)
    return made


def variable(name: str) -> RecordedCall:
    return said("LaunchConfiguration", name)


def log(message: str) -> RecordedCall:
    return said("LogInfo", msg=message)


def logged(made: Any) -> list[str]:
    return [action["log"]["message"] for action in actions(made) if "log" in action]


class Twice(said("Action").__class__):  # type: ignore[misc]
    """An action of a file's own."""

    def __init__(self, word: str, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.word = word

    def execute(self, context: Context) -> list[RecordedCall]:
        return [log(self.word), log(context.launch_configurations["n"])]


def test_loops() -> None:
    """A function is called with each number, or with each mapping of a text."""
    assert logged(said("ForLoop", variable("n"), function=lambda i: [log(f"no {i}")])) == ["no 0", "no 1"]
    each = said("ForEach", variable("robots"), function=lambda name, x=0.0: [log(f"{name} {x}")])
    assert logged(each) == ["a 0.0", "b 1.5"]
    with pytest.raises(TypeError, match=r"expected mappings, such as .*, got 'a'"):
        actions(said("ForEach", "a", function=print))


def test_an_action_of_a_files_own() -> None:
    """What its `execute` returns takes its place."""
    assert logged([Twice("a"), Twice("b", condition=said("IfCondition", "false"))]) == ["a", "2"]


def test_code_with_a_condition() -> None:
    """It is not called where that is false."""
    off = said("UnlessCondition", "true")
    assert actions(said("OpaqueFunction", function=lambda _: 1 / 0, condition=off)) == []
    handler = said("OnShutdown", on_shutdown=[])
    assert actions(said("RegisterEventHandler", handler, condition=off)) == []


def test_what_a_function_carries_out_itself() -> None:
    """It comes before what the function returns, and what is set so is known at once."""

    def function(context: Context) -> list[RecordedCall]:
        said("SetLaunchConfiguration", "n", "3").execute(context)
        assert Twice("inner").visit(context)
        log("now").visit(context)
        return [log(variable("n").perform(context))]

    assert logged([said("OpaqueFunction", function=function), log("later")]) == ["now", "3", "later"]


def test_code_in_a_file_that_is_only_written_down() -> None:
    """It is called once, which is told."""
    RECORDING.values = None
    assert logged(said("OpaqueFunction", function=lambda context: [log(variable("x").perform(context))])) == [
        "$(var x)"
    ]
    assert actions(said("ForLoop", variable("n"), function=print)) == []
    messages = [problem["message"] for problem in RECORDING.problems]
    assert messages[0].startswith("OpaqueFunction: it was called once")
    assert messages[1].startswith("ForLoop has no equivalent in a graph file")
