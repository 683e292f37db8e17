"""Python's logging as ROS 2's."""

from __future__ import annotations

import io
import logging
import logging.config
import threading
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr
from unittest.mock import patch

import pytest

from graphflow import GraphflowError, Node, Qos
from graphflow.msgs.rcl_interfaces.msg import Log
from graphflow.qos import Durability
from graphflow.runtime.logs.logger import ROOT, node_logger
from graphflow.runtime.logs.rosout import Console, ConsoleFormatter, log_level, setup_console
from graphflow.testing import Graph
from graphflow.testing.graph import TRANSIENT_LOCAL


@pytest.fixture(autouse=True)
def all_levels() -> Iterator[None]:
    """Everything from debug on is logged."""
    logger = logging.getLogger("graphflow")
    before = logger.level
    logger.setLevel(logging.DEBUG)
    yield
    logger.setLevel(before)


@pytest.mark.parametrize(
    ("level", "number"),
    [
        (logging.DEBUG, Log.DEBUG),
        (logging.INFO, Log.INFO),
        (logging.WARNING, Log.WARN),
        (logging.ERROR, Log.ERROR),
        (logging.CRITICAL, Log.FATAL),
    ],
)
async def test_records_reach_rosout(graph: Graph, level: int, number: int) -> None:
    """With the level's number, the node's dotted name, the text, and where it was written."""
    node = Node("follower", namespace="/turtle1")
    await graph.start(node)
    heard = graph.tap(Log, "/rosout")

    node.log.log(level, "at %d%%", 50)
    await graph.settle()

    [record] = heard
    assert record.level == number
    assert record.name == "turtle1.follower"
    assert record.msg == "at 50%"
    assert record.file == __file__
    assert record.function == "test_records_reach_rosout"
    assert record.line > 0
    assert record.stamp.sec > 0


async def test_a_latecomer_gets_the_history(graph: Graph) -> None:
    """/rosout is TRANSIENT_LOCAL: earlier records are available to late subscriptions."""
    node = Node("talker")
    await graph.start(node)
    node.log.info("early")
    late = graph.tap(Log, "/rosout", TRANSIENT_LOCAL)
    fresh = graph.tap(Log, "/rosout", Qos(durability=Durability.VOLATILE))
    await graph.settle()
    node.log.info("later")
    await graph.settle()

    assert [r.msg for r in late] == ["early", "later"]
    assert [r.msg for r in fresh] == ["later"]


async def test_only_while_the_node_runs(graph: Graph) -> None:
    """Before its start and after its stop a node's records stay at home."""
    heard = graph.tap(Log, "/rosout")
    node = Node("talker")
    node.log.info("before")
    await graph.start(node)
    node.log.info("during")
    await graph.stop(node)
    node.log.info("after")
    await graph.settle()

    assert [r.msg for r in heard if r.name == "talker"] == ["during"]


async def test_a_node_speaks_for_itself_only(graph: Graph) -> None:
    """A record appears once, also when the name of one node is the beginning of another's; child loggers count."""
    parent, child = Node("arm"), Node("hand", namespace="/arm")
    await graph.start(parent, child)
    heard = graph.tap(Log, "/rosout")

    child.log.info("from the hand")
    child.log.getChild("thumb").info("from the thumb")
    parent.log.info("from the arm")
    await graph.settle()

    assert [(r.name, r.msg) for r in heard] == [
        ("arm.hand", "from the hand"),
        ("arm.hand.thumb", "from the thumb"),
        ("arm", "from the arm"),
    ]


async def test_records_from_threads_reach_rosout(graph: Graph) -> None:
    """A worker thread may log, and so may a node that was made in another thread than it runs in."""
    made: list[Node] = []
    maker = threading.Thread(target=lambda: made.append(Node("elsewhere")))
    maker.start()
    maker.join()
    node = made[0]
    await graph.start(node)
    heard = graph.tap(Log, "/rosout")

    await node.offload(node.log.info, "from a thread")
    node.log.info("from the loop")
    await graph.settle()

    assert {r.msg for r in heard} == {"from a thread", "from the loop"}


async def test_a_record_that_cannot_be_written_is_no_error_of_the_node(
    graph: Graph, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As with Python's own handlers, stderr has the error, and the caller continues."""
    node = Node("talker")
    await graph.start(node)
    monkeypatch.setattr(node.log, "propagate", False)
    heard = graph.tap(Log, "/rosout")

    node.log.info("%d", "no number")
    node.log.info("half a surrogate \ud800")
    node.log.info("good")
    await graph.settle()

    assert [r.msg for r in heard][-1] == "good"
    assert "--- Logging error ---" in capsys.readouterr().err


async def test_a_node_without_rosout(graph: Graph) -> None:
    """`enable_rosout=False` is for tools that only look."""
    node = Node("tool", enable_rosout=False)
    await graph.start(node)

    assert "/rosout" not in node.context.cache.topics()


def record(level: int, text: str, **more: object) -> logging.LogRecord:
    made = logging.LogRecord(f"{ROOT}.turtle1.follower", level, "file.py", 1, text, (), None)
    made.created = 1700000000.25
    for name, value in more.items():
        setattr(made, name, value)
    return made


@pytest.mark.parametrize(
    ("level", "word"),
    [(10, "DEBUG"), (20, "INFO"), (30, "WARN"), (40, "ERROR"), (50, "FATAL")],
)
def test_the_console_line_is_ros2s(level: int, word: str) -> None:
    """Level, time, name, text."""
    line = ConsoleFormatter().format(record(level, "hello"))

    assert line == f"[{word}] [1700000000.250000000] [turtle1.follower]: hello"


def test_a_traceback_follows_its_line() -> None:
    """An error's traceback is under its line."""
    try:
        raise ValueError("wrong")
    except ValueError as error:
        made = record(40, "it failed", exc_info=(ValueError, error, error.__traceback__))

    first, *rest = ConsoleFormatter().format(made).splitlines()
    assert first.endswith("it failed")
    assert rest[0] == "Traceback (most recent call last):"
    assert rest[-1] == "ValueError: wrong"


def test_loggers_are_named_as_ros2_does() -> None:
    """Slashes become dots."""
    assert node_logger("/a/b").name == f"{ROOT}.a.b"
    assert node_logger("/a").name == f"{ROOT}.a"


def test_the_console_is_set_up_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second call changes the level only."""
    logger = logging.getLogger("graphflow")
    monkeypatch.setattr(logger, "handlers", [])
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)

    setup_console()
    setup_console(logging.ERROR)
    node_logger("/talker").warning("not this")
    node_logger("/talker").error("this")

    assert stream.getvalue().count("\n") == 1
    assert stream.getvalue().endswith("[talker]: this\n")


class Shows(logging.Handler):
    """A handler of the program's own."""

    def emit(self, record: logging.LogRecord) -> None:
        """It may show the record anywhere."""


@contextmanager
def unconfigured() -> Iterator[io.StringIO]:
    """Set logging to its state in an unconfigured program; returns the text on stderr."""
    root, own = logging.getLogger(), logging.getLogger("graphflow")
    stream = io.StringIO()
    # Within the test, since pytest has handlers of its own for each phase.
    with patch.object(root, "handlers", []), patch.object(own, "handlers", []), redirect_stderr(stream):
        yield stream


async def test_warnings_and_errors_are_seen_without_any_configuration(graph: Graph) -> None:
    """A program of one's own need not configure logging: /rosout does not count as a place where they are seen."""
    node = Node("talker")
    with unconfigured() as stderr:
        await graph.start(node)
        node.log.info("not this")
        node.log.warning("this")
        node.log.getChild("part").error("and this")
        logging.getLogger("graphflow").error("and of the process, this")

    assert [line.rpartition("] [")[2] for line in stderr.getvalue().splitlines()] == [
        "talker]: this",
        "talker.part]: and this",
        "graphflow]: and of the process, this",
    ]


@pytest.mark.parametrize("where", ["", "graphflow", "graphflow.node.talker"])
async def test_a_program_that_configures_logging_is_obeyed(graph: Graph, where: str) -> None:
    """Its handler receives the records, wherever and whenever it is added; stderr gets no duplicates."""
    node, handler = Node("talker"), Shows()
    with unconfigured() as stderr:
        await graph.start(node)
        logging.getLogger(where).addHandler(handler)
        node.log.error("elsewhere")
    node.log.removeHandler(handler)

    assert stderr.getvalue() == ""


async def test_the_console_follows_stderr(graph: Graph) -> None:
    """A notebook replaces it, and a program may redirect it for a while."""
    node = Node("talker")
    with unconfigured() as stderr:
        await graph.start(node)
        with redirect_stderr(io.StringIO()) as later:
            node.log.error("to the cell")

    assert stderr.getvalue() == ""
    assert later.getvalue().endswith("[talker]: to the cell\n")


def test_a_console_of_last_resort_can_be_wanted() -> None:
    """A node may run before the console is set up: there is one console, and no line is written twice."""
    with unconfigured() as stderr:
        console = Console.installed()
        setup_console()
        node_logger("/talker").info("this")
        assert Console.installed() is console

    assert stderr.getvalue().count("[talker]: this\n") == 1


@pytest.mark.parametrize(
    ("word", "level"),
    [("debug", 10), ("INFO", 20), ("warn", 30), ("warning", 30), ("error", 40), ("fatal", 50)],
)
def test_levels_by_word(word: str, level: int) -> None:
    """ROS 2's words, in any case."""
    assert log_level(word) == level


def test_a_level_that_is_none() -> None:
    """The error offers the nearest."""
    with pytest.raises(GraphflowError, match="'debg' is not a log level; did you mean 'debug'"):
        log_level("debg")


LIBRARY = {
    "version": 1,
    "handlers": {"file": {"class": "logging.NullHandler"}},
    "root": {"handlers": ["file"], "level": "INFO"},
}


@pytest.fixture
def root() -> Iterator[logging.Logger]:
    """The root logger, which is as it was when the test has ended."""
    logger, manager = logging.getLogger(), logging.Logger.manager
    before, level = list(logger.handlers), logger.level
    disabled = {name: each.disabled for name, each in manager.loggerDict.items() if isinstance(each, logging.Logger)}
    yield logger
    logger.handlers, logger.level = before, level
    for name, was in disabled.items():
        logging.getLogger(name).disabled = was


async def test_the_log_survives_the_configuration_of_a_library(graph: Graph, root: logging.Logger) -> None:
    """Although it disables all loggers that it does not name, and closes all handlers."""
    node = Node("robot")
    await graph.start(node)
    heard = graph.tap(Log, "/rosout")
    logging.config.dictConfig(LIBRARY)
    assert logging.getLogger("tests.other").disabled is False
    node.log.error("the arm is stuck")
    logging.getLogger("graphflow").error("blocked")
    await graph.settle()
    assert [record.msg for record in heard] == ["the arm is stuck"]
    assert not logging.getLogger("graphflow").disabled


async def test_a_program_may_switch_a_log_off(graph: Graph) -> None:
    """That is no accident of a library's."""
    node = Node("robot")
    await graph.start(node)
    heard = graph.tap(Log, "/rosout")
    node.log.disabled = True
    node.log.error("the arm is stuck")
    node.log.disabled = False
    await graph.settle()
    assert not heard


async def test_nothing_is_shown_twice(graph: Graph, root: logging.Logger) -> None:
    """When `basicConfig` adds another handler for the terminal; one for a file receives all records."""
    node, shown, file = Node("robot"), io.StringIO(), io.StringIO()
    await graph.start(node)
    console = Console.installed()
    before = console.is_wanted
    with redirect_stderr(shown):
        setup_console()
        root.handlers = [logging.StreamHandler(), logging.StreamHandler(file)]
        node.log.warning("the arm is slow")
        logging.getLogger("vendor").warning("no news")
    console.is_wanted = before
    assert shown.getvalue().count("the arm is slow") == 1
    assert "no news" in shown.getvalue()
    assert "the arm is slow" in file.getvalue()
