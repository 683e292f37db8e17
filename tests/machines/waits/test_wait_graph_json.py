"""Pictures of waits on their way between processes."""

from __future__ import annotations

import json
from typing import Any, get_args

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from graphflow.errors import Place
from graphflow.interface import GroupChange, WhenFull
from graphflow.machines.regrouping import Regrouping
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    GroupView,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    TransformWait,
    WaitGraph,
)
from graphflow.machines.waits.wait_graph_json import DEEPEST, VERSION, from_json, to_json
from tests.cases import count, slow

TEXT = st.text(max_size=5)
TEXTS = st.lists(TEXT, max_size=3).map(tuple)
WHOLE = st.integers()
FLOATS = st.floats(allow_nan=False)


def joint(conditions: st.SearchStrategy[Condition]) -> st.SearchStrategy[Condition]:
    several = st.lists(conditions, max_size=3).map(tuple)
    return st.builds(All, several) | st.builds(AnyOf, several)


CONDITIONS: st.SearchStrategy[Condition] = st.recursive(
    st.just(FREE)
    | st.builds(Call, TEXT, TEXT, WHOLE)
    | st.builds(Slot, TEXT, WHOLE)
    | st.builds(Opening, TEXT)
    | st.builds(Join, TEXT)
    | st.builds(SetBy, TEXT, TEXTS, TEXTS, st.booleans(), TEXT, st.booleans())
    | st.builds(TransformWait, TEXT, TEXTS, TEXTS, TEXT),
    joint,
    max_leaves=6,
)
ACTIVITIES = st.builds(
    ActivityView,
    id=TEXT,
    label=TEXT,
    node=TEXT,
    holds=TEXTS,
    wait=CONDITIONS,
    serves=TEXT,
    place=st.builds(Place, TEXT, WHOLE, WHOLE),
    function=TEXT,
    age=FLOATS,
    left=st.none() | FLOATS,
    process=TEXT,
    is_inner=st.booleans(),
    sends=st.none() | TEXTS,
)
GROUPS = st.builds(GroupView, TEXT, TEXT, TEXT, st.none() | st.integers(1, 9))
QUEUES = st.builds(QueueView, TEXT, TEXT, TEXT, TEXTS, TEXTS, WHOLE, WHOLE, TEXT, sends=st.none() | TEXTS)
CHANGES = st.builds(
    GroupChange,
    TEXTS,
    st.none() | st.integers(1, 9),
    st.booleans(),
    st.none() | st.sampled_from(get_args(WhenFull)),
    st.none() | st.booleans(),
)
REGROUPINGS = st.builds(Regrouping, st.dictionaries(TEXT, CHANGES, max_size=2), TEXT, TEXT, WHOLE)
PICTURES = st.builds(
    WaitGraph,
    st.lists(ACTIVITIES, max_size=3).map(lambda some: {a.id: a for a in some}),
    st.lists(GROUPS, max_size=3).map(lambda some: {g.id: g for g in some}),
    st.lists(QUEUES, max_size=3).map(lambda some: {q.id: q for q in some}),
    st.dictionaries(TEXT, TEXT, max_size=3),
    st.dictionaries(
        TEXT, st.builds(Regrouping, st.dictionaries(TEXT, CHANGES, max_size=2), TEXT, TEXT, WHOLE), max_size=2
    ),
)
JUNK: st.SearchStrategy[Any] = st.recursive(
    st.none()
    | st.booleans()
    | WHOLE
    | st.floats()
    | TEXT
    | st.sampled_from(["call", "slot", "open", "join", "set", "all", "transform"]),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXT, inner, max_size=3),
    max_leaves=8,
)


@slow
@settings(deadline=None, derandomize=True)
@given(PICTURES)
def test_round_trip(picture: WaitGraph) -> None:
    """A picture comes out of JSON's text as it went in."""
    assert from_json(json.loads(json.dumps(to_json(picture)))) == picture


def one(wait: object = None, age: object = 0.0) -> dict[str, Any]:
    """The JSON of a picture of one activity, which waits for this."""
    data: dict[str, Any] = to_json(WaitGraph({"a": ActivityView("a", "timer tick", "/n")}))
    data["activities"][0][4], data["activities"][0][8] = wait, age
    return data


@st.composite
def damaged(draw: st.DrawFn) -> Any:
    """The JSON of a picture of which one part, however deep, is missing or something else."""
    data: Any = to_json(draw(PICTURES))
    part: Any = data
    while True:
        keys = list(part) if isinstance(part, dict) else list(range(len(part)))
        if not keys:
            return data
        key = draw(st.sampled_from(keys))
        if isinstance(part[key], (dict, list)) and part[key] and draw(st.integers(0, 3)):
            part = part[key]
            continue
        if draw(st.booleans()):
            del part[key]
        else:
            part[key] = draw(JUNK)
        return data


@slow
@settings(deadline=None, derandomize=True, max_examples=count(few=125, full=500))
@given(damaged() | JUNK | JUNK.map(one))
@example(one(["call", "id"]))
@example(one(["set", "self.arrived", []]))
@example(one(["all"]))
@example(one(age=10**400))
def test_what_is_no_picture(data: Any) -> None:
    """Whatever comes, it is a picture or one of the three errors that are promised."""
    try:
        picture = from_json(data)
    except (ValueError, KeyError, TypeError):
        return
    assert from_json(to_json(picture)) == picture or "nan" in repr(picture)


@pytest.mark.parametrize(
    ("key", "value", "error"),
    [
        ("v", VERSION + 1, ValueError),
        ("activities", None, TypeError),
        ("activities", [["a"]], ValueError),
        ("groups", [["g", "g", "/n", "1", True, False, False, ""]], TypeError),
        ("groups", [["g", "g", "/n"]], ValueError),
        ("groups", [["g", "g", "/n", 0, True, False, True, ""]], ValueError),
        ("groups", [["g", "g", "/n", True, True, False, False, ""]], TypeError),
        ("groups", [["g", "g", "/n", 1, True, False, False, "pool"]], ValueError),
        ("queues", [["q", "service q", "/n", ["g"], ["c", 1], 0, 0, "p", True, [], None]], TypeError),
        ("blocked", ["p"], TypeError),
        ("blocked", {"p": 1}, TypeError),
    ],
)
def test_parts_that_are_wrong(key: str, value: object, error: type[Exception]) -> None:
    """Another version, and parts of another shape or type, are refused; so is a picture without them."""
    data: dict[str, Any] = to_json(WaitGraph())
    with pytest.raises(error):
        from_json({**data, key: value})
    del data[key]
    with pytest.raises(KeyError):
        from_json(data)


@pytest.mark.parametrize(
    "wait",
    [
        ["later"],
        ["set", "it", [], [], 1],
        [],
        "call",
        [["call"]],
        ["call", "c", 1],
        ["slot", "g", "1"],
        ["open", 1],
        ["all", [1]],
    ],
)
def test_conditions_that_are_wrong(wait: object) -> None:
    """Only conditions of known kinds are read, and only with parts of the right types."""
    with pytest.raises((ValueError, TypeError)):
        from_json(one(wait))


def nested(levels: int) -> list[Any]:
    data: list[Any] = ["call", "c", "/add", 1]
    for level in range(levels):
        data = ["any" if level % 2 else "all", [data]]
    return data


@slow
def test_how_deep_conditions_go() -> None:
    """Conditions inside each other are written and read to a limit, far below that of the stack."""
    deep: Condition = Call("c", "/add")
    for _ in range(DEEPEST + 1):
        deep = All((deep,))
    written = to_json(WaitGraph({"a": ActivityView("a", "timer tick", "/n", wait=deep)}))
    assert from_json(json.loads(json.dumps(written))).activities["a"].wait != deep
    picture = from_json(one(nested(DEEPEST)))
    assert to_json(picture)["activities"] == one(nested(DEEPEST))["activities"]

    for levels in (DEEPEST + 1, 100_000):
        with pytest.raises(ValueError, match="nested too deeply"):
            from_json(one(nested(levels)))
