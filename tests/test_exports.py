"""The public names: one list, told three times, and all of them there."""

from __future__ import annotations

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest

import graphflow

TREE = ast.parse(Path(graphflow.__file__).read_text(encoding="utf-8"))


def seen_by_the_type_checker() -> dict[str, str]:
    """Name -> module, as imported under TYPE_CHECKING."""
    (block,) = [n for n in TREE.body if isinstance(n, ast.If)]
    assert ast.unparse(block.test) == "TYPE_CHECKING"
    imports = [n for n in block.body if isinstance(n, ast.ImportFrom)]
    assert len(imports) == len(block.body)
    return {alias.asname or alias.name: str(n.module) for n in imports for alias in n.names}


def imported_when_used() -> dict[str, str]:
    """Name -> module, as imported at run time."""
    return {name: home for home, names in graphflow._HOMES.items() for name in names}


def test_the_three_lists_are_one() -> None:
    """`__all__`, the names imported when used and those the type checker sees are the same, from the same modules."""
    assert imported_when_used() == seen_by_the_type_checker()
    assert sorted(imported_when_used()) == graphflow.__all__


def test_no_name_is_listed_twice() -> None:
    """A name has one home."""
    listed = [name for names in graphflow._HOMES.values() for name in names]
    assert len(listed) == len(set(listed))
    assert len(graphflow.__all__) == len(set(graphflow.__all__))


ROOMS = {path.stem for path in Path(graphflow.__file__).parent.iterdir() if not path.stem.startswith("_")}


def test_no_name_is_also_a_module() -> None:
    """Importing a module of the package sets its name on the package, which would hide a public name."""
    assert not ROOMS & set(graphflow.__all__)


@pytest.mark.parametrize("name", sorted(set(graphflow.__all__) - ROOMS))
def test_every_name_is_there(name: str) -> None:
    """A public name is what its home calls by that name."""
    assert getattr(graphflow, name) is getattr(import_module(imported_when_used()[name]), name)


def test_a_star_import_gives_all_of_them() -> None:
    """`from graphflow import *` brings every public name."""
    names: dict[str, object] = {}
    exec("from graphflow import *", names)
    assert set(graphflow.__all__) <= names.keys()


def test_an_unknown_name_is_an_attribute_error() -> None:
    """A misspelt name is Python's usual error, for `hasattr` and for people."""
    with pytest.raises(AttributeError, match="module 'graphflow' has no attribute 'Nod'"):
        graphflow.Nod  # noqa: B018
    assert not hasattr(graphflow, "_nothing")


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("Nod", "graphflow has no Nod; did you mean 'Node'?"),
        ("Task", "graphflow has no Task; the decorator is written @task"),
        ("Run", "graphflow has no Run; the function is written run"),
        ("nothing_alike", "cannot import name 'nothing_alike' from 'graphflow'"),
    ],
)
def test_an_import_of_an_unknown_name(name: str, told: str) -> None:
    """It names the one that is meant."""
    with pytest.raises(ImportError, match=re.escape(told)):
        exec(f"from graphflow import {name}")
