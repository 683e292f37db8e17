"""Names and times that bags do not have."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.bag.missing import check_messages, remarks
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import Choice
from graphflow.errors import BagError
from tests.bag.cast import START, write

SECOND = 10**9


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"topics": frozenset({"/count", "/chater"})}, "no topic /chater; did you mean '/chatter'?"),
        ({"exclude": frozenset({"/x"})}, "no topic /x; there is /chatter, /count, /map"),
        ({"services": frozenset({"/add"})}, "no call of the service /add"),
        (
            {"exclude_types": frozenset({"std_msgs/msg/Strin"})},
            "no topic of type std_msgs/msg/Strin; did you mean 'std_msgs/msg/String'?",
        ),
    ],
)
def test_names(tmp_path: Path, options: dict[str, Any], told: str) -> None:
    """Each is told with the nearest that is there."""
    assert remarks([Bag(write(tmp_path / "bag"))], Choice(**options)) == [told]


def test_a_name_in_one_of_several(tmp_path: Path) -> None:
    """Is there."""
    bags = [Bag(write(tmp_path / "a", [])), Bag(write(tmp_path / "b"))]
    assert remarks(bags, Choice(topics=frozenset({"/count"})), ["/chatter"]) == []


@pytest.mark.parametrize(
    ("topics", "start", "end", "told"),
    [
        ((), 0.0, None, "no topic matches; there is /chatter, /count, /map"),
        (("/count",), 500.0, None, "no message of /count from 500 s on; it lasts 1.95 s"),
        (("/count",), 0.0, 0.04, "no message of /count before 0.04 s; it lasts 1.95 s"),
        (("/map",), 1.0, 1.5, "no message of /map from 1 s on before 1.5 s; it lasts 1.95 s"),
    ],
)
def test_no_messages(tmp_path: Path, topics: tuple[str, ...], start: float, end: float | None, told: str) -> None:
    """Are an error that says what there is."""
    bag = Bag(write(tmp_path / "bag"))
    end_ns = None if end is None else START + round(end * SECOND)
    with pytest.raises(BagError, match=told):
        check_messages([bag], topics, (), START + round(start * SECOND), end_ns)


def test_messages(tmp_path: Path) -> None:
    """In the time that is asked for; of a bag that is empty, none are expected."""
    check_messages([Bag(write(tmp_path / "bag"))], ["/count"], (), START + SECOND, START + 2 * SECOND)
    check_messages([Bag(write(tmp_path / "empty", []))], [], (), START, None)
