"""Errors: the tree in the drawing is the real one, and what some of them carry."""

from __future__ import annotations

import re
import signal
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import graphflow
from graphflow import errors
from graphflow.errors import (
    Abort,
    CallTimeout,
    GraphFileError,
    GraphflowError,
    Place,
    Problem,
    RemoteError,
    SupervisorError,
    printable,
    uncoloured,
)

ESCAPE = "\x1b[2J\x9b31m\a"
"""What a terminal obeys: it is cleared, and writes in red from then on, and rings."""


def drawn(drawing: str) -> dict[str, str]:
    """Each class of the drawing with the one that it hangs from."""
    above: list[str] = []
    found: dict[str, str] = {}
    for line in drawing.splitlines():
        if branch := re.match(r"((?:[|`]   |    )*)(?:[|`]-- )?(\w+)", line):
            depth = len(branch[1]) // 4 + ("-- " in line)
            del above[depth:]
            found[branch[2]] = above[-1] if above else ""
            above.append(branch[2])
    return found


def whole_tree(cls: type[BaseException]) -> Iterator[type[BaseException]]:
    """A class and all that derive from it, those in graphflow's modules."""
    if cls.__module__.partition(".")[0] == "graphflow":
        yield cls
        for child in cls.__subclasses__():
            yield from whole_tree(child)


def import_everything() -> None:
    """Import every module of the package, so that no class is missing."""
    root, handler = Path(graphflow.__file__).parent, signal.getsignal(signal.SIGINT)
    for path in set(root.rglob("*.py")) - {root / "__main__.py"}:  # which would run a command
        if {root / "rclpy" / "site", root / "rclpy" / "packages"} & {*path.parents}:  # ROS's names, and rclpy's errors
            continue
        if "rerun" in path.parts and find_spec("rerun") is None:  # an extra
            continue
        words = path.relative_to(root.parent).with_suffix("").parts
        import_module(".".join(words).removesuffix(".__init__"))
    signal.signal(signal.SIGINT, handler)  # the way in has its own, which ends the process


def test_the_drawing_is_the_tree() -> None:
    """Every error of the whole package stands in errors.py and in its drawing, under the class that it derives from."""
    import_everything()
    classes = list(whole_tree(GraphflowError))

    assert {cls.__module__ for cls in classes} == {"graphflow.errors"}
    assert errors.__doc__ is not None
    _, _, drawing = errors.__doc__.partition("\n\n")
    real = {
        cls.__name__: next(b.__name__ for b in cls.__bases__ if issubclass(b, GraphflowError)) for cls in classes[1:]
    }
    assert drawn(drawing) == {"GraphflowError": "", **real}


def test_what_is_drawn_is_read() -> None:
    """The reader of the drawing sees who hangs from whom."""
    drawing = "A   all\n|-- B       one\n|   `-- C   two\n|       `-- D  three\n`-- E       four\n    `-- F   five\n"

    assert drawn(drawing) == {"A": "", "B": "A", "C": "B", "D": "C", "E": "A", "F": "E"}


def test_places_and_problems_read_as_editors_want_them() -> None:
    """File, line and column with colons between them; what is not known is left out."""
    assert str(Place("a.yaml", 3, 7)) == "a.yaml:3:7"
    assert str(Place("a.yaml", 3)) == "a.yaml:3"
    assert str(Place("a.yaml")) == "a.yaml"
    assert str(Problem(Place("a.yaml", 3, 7), "odd")) == "a.yaml:3:7: odd"


def test_problems_of_a_file_come_in_its_order() -> None:
    """However they were found; the text has one a line."""
    late, early = Problem(Place("a.yaml", 10, 1), "second"), Problem(Place("a.yaml", 9, 4), "first")

    error = GraphFileError([late, early])

    assert error.problems == (early, late)
    assert str(error) == "a.yaml:9:4: first\na.yaml:10:1: second"


def test_a_supervisors_error_has_an_exit_code() -> None:
    """1 unless another is said."""
    assert SupervisorError("no").exit_code == 1
    assert SupervisorError("nobody", exit_code=3).exit_code == 3


def test_a_deadline_that_passed_is_a_timeout_to_asyncios_users_too() -> None:
    """Whoever catches TimeoutError catches it."""
    assert issubclass(CallTimeout, TimeoutError)


@pytest.mark.parametrize(
    ("abort", "result", "text"),
    [
        (Abort(), None, ""),
        (Abort("the way is blocked"), None, "the way is blocked"),
        (Abort(3), 3, ""),
        (Abort(3, "the way is blocked"), 3, "the way is blocked"),
        (Abort(reason="the way is blocked"), None, "the way is blocked"),
    ],
)
def test_an_abort_has_a_result_or_a_reason_or_both(abort: Abort, result: object, text: str) -> None:
    """A text alone is the reason."""
    assert abort.result == result
    assert str(abort) == text


def test_nothing_of_a_foreign_text_is_obeyed_by_a_terminal() -> None:
    """Escape sequences and control characters are spelt out, lines stay lines, and letters of all languages letters."""
    assert printable(f"{ESCAPE}Größe: 3\nﾆ\r\u202e") == "\\x1b[2J\\x9b31m\\x07Größe: 3\nﾆ\\r\\u202e"


def test_a_foreign_text_is_cut() -> None:
    """Nobody can fill a log with one error."""
    assert len(printable("x" * 1_000_000)) == errors.LONGEST_TEXT


def test_an_error_reply_is_read_as_it_was_written() -> None:
    """Type and message arrive, and the text says whose handler it was."""
    sent = RemoteError("ValueError", "7 is too much")
    received = RemoteError.from_payload(sent.to_payload(), "/add")

    assert (received.type, received.message) == ("ValueError", "7 is too much")
    assert str(sent) == "ValueError: 7 is too much"
    assert str(received) == "the handler of /add raised ValueError: 7 is too much"


def test_an_error_reply_clears_no_screen() -> None:
    """Neither by its type nor by its message."""
    error = RemoteError.from_payload(RemoteError(ESCAPE, f"no{ESCAPE}").to_payload(), "/add")

    assert not re.search("[\x00-\x1f\x7f-\x9f]", f"{error}{error.type}{error.message}")
    assert error.message == "no\\x1b[2J\\x9b31m\\x07"


@pytest.mark.parametrize(
    ("payload", "message"),
    [
        (b"no JSON", "no JSON"),
        (b"\x1b[2J\xff", "\\x1b[2J\N{REPLACEMENT CHARACTER}"),
        (b"[1]", "[1]"),
        (b'{"type": "ValueError"}', '{"type": "ValueError"}'),
        (b"x" * 1000, "x" * 200),
    ],
)
def test_an_error_reply_of_another_form_is_the_message(payload: bytes, message: str) -> None:
    """As far as it can be printed; its beginning, if it is long."""
    error = RemoteError.from_payload(payload, "/add")

    assert (error.type, error.message) == ("Error", message)


def test_a_line_of_a_log_has_no_colours() -> None:
    """Those that a program gives it are left out; what else a terminal would obey is shown."""
    assert uncoloured("\x1b[1;32mgreen\x1b[0m \x1b[2J") == "green \\x1b[2J"
    assert uncoloured("plain") == "plain"
