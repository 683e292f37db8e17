"""Values that are moved and merged with their places."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from graphflow.errors import Place
from graphflow.markup import source
from graphflow.markup.tree import Item, first_of, items, located, merged, shared, source_of, tree
from tests.cases import slow

TEXT = "a: 1\nb: {c: [x, {d: 2}], e: }\n"
HERE, THERE = Place("f.yaml", 1, 1), Place("g.yaml", 2, 2)


def test_there_and_back() -> None:
    """A file is the same after it was a tree: values, places and keys."""
    src = source.read(TEXT, "f.yaml")
    top = tree(src)
    assert source_of(top) == src
    assert top.plain() == src.data
    assert top.entries["b"].at == Place("f.yaml", 2, 1)
    assert top.entries["b"].entries["c"].items[1].entries["d"].place == Place("f.yaml", 2, 16)


def test_items() -> None:
    """One alone may stand without a list."""
    entries = tree(source.read("{a: [1, 2], b: 3}\n", "f.yaml")).entries
    assert [[i.plain() for i in items(entries.get(key))] for key in ("a", "b", "c")] == [[1, 2], [3], []]


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=20,
)


@slow
@given(VALUES)
def test_any_value_at_one_place(value: source.Data) -> None:
    """A plain value becomes a tree that was written at one place, and is itself again."""
    item = located(value, HERE)
    assert item.plain() == value
    assert set(source_of(item).places.values()) == {HERE}


def test_one_over_the_other() -> None:
    """Entries are replaced as a whole, but those merged by entry keep what the other does not name."""
    base = located({"params": {"a": 1, "b": 2}, "remap": {"x": "y"}, "class": "m:C"}, HERE)
    over = located({"params": {"b": 3}, "remap": {"z": "w"}, "env": {}}, THERE)
    assert merged(base, over, ("params",)).plain() == {
        "params": {"a": 1, "b": 3},
        "remap": {"z": "w"},
        "class": "m:C",
        "env": {},
    }
    params = merged(base, over, ("params",)).entries["params"].entries
    assert (params["a"].place, params["b"].place) == (HERE, THERE)
    assert merged(base, located({"params": 3}, THERE), ("params",)).entries["params"].value == 3


def test_the_first_counts() -> None:
    """Of several mappings, in their order."""
    first, second = ({name: Item(value, HERE) for name, value in pairs} for pairs in ([("a", 1)], [("b", 2), ("a", 3)]))
    assert {name: item.value for name, item in first_of([first, second]).items()} == {"a": 1, "b": 2}


def test_what_is_no_mapping_has_no_entries() -> None:
    """It can be asked all the same."""
    item = Item(3, HERE)
    assert (item.entries, item.without("a")) == ({}, item)
    assert located({"a": 1, "b": 2}, HERE).without("a", "c").plain() == {"b": 2}


def test_what_mappings_share() -> None:
    """The first that has an entry counts."""
    inner, outer = located({"env": {"a": 1}}, HERE), located({"env": {"a": 2, "b": 3}}, HERE)
    assert shared("env", [inner.entries, {}, outer.entries]) == {"a": 1, "b": 3}
    assert shared("params", [inner.entries]) == {}
