"""The page about how graphflow is built names what is there."""

from __future__ import annotations

import importlib
import re

import pytest

from graphflow.machines.goal import Phase
from tests.conftest import PROJECT
from tests.test_layers import ENTRY_POINTS, PACKAGES

PAGE = (PROJECT / "docs" / "architecture.md").read_text(encoding="utf-8")
FILES = sorted(set(re.findall(r"`([a-z_]+/[a-z_/]+\.py)`", PAGE)))

LIMITS = re.findall(r"^\| ([\d.]+) \| .*: `([A-Z_]+)` \| `([a-z_/]+\.py)` \|$", PAGE, re.MULTILINE)
assert len(LIMITS) == 6, "the table of limits is not read"


@pytest.mark.parametrize("file", FILES)
def test_every_file_that_it_names_is_there(file: str) -> None:
    """As a file of the package, or of the repository."""
    assert (PROJECT / "graphflow" / file).exists() or (PROJECT / file).exists()


def test_every_package_is_in_the_picture() -> None:
    """In the order in which imports go down."""
    picture = PAGE[PAGE.index("```text") : PAGE.index("A pure function decides")]
    packages = [package for package in reversed(PACKAGES) if (PROJECT / "graphflow" / package).is_dir()]
    places = [picture.index(f"  {package}/ ") for package in packages]
    assert places == sorted(places)
    assert set(ENTRY_POINTS) <= set(packages)


def test_the_life_of_a_goal_is_that_of_the_table() -> None:
    """Every phase is in it."""
    assert all(phase.name in PAGE for phase in Phase if phase is not Phase.REJECTED)


@pytest.mark.parametrize(("seconds", "name", "file"), LIMITS)
def test_every_limit_has_its_value(seconds: str, name: str, file: str) -> None:
    """In the file that the page names."""
    module = importlib.import_module(f"graphflow.{file.removesuffix('.py').replace('/', '.')}")
    assert getattr(module, name) == float(seconds)


def test_every_row_that_a_test_cites_is_there() -> None:
    """`(row 5)` in the docstring of a test of the search."""
    rows = {int(n) for cell in re.findall(r"^\| ([\d, ]+) \|", PAGE, re.MULTILINE) for n in cell.split(",")}
    assert rows == set(range(1, 31))
    for path in (PROJECT / "tests").rglob("test_*.py"):
        assert {int(n) for n in re.findall(r"\(row (\d+)\)", path.read_text(encoding="utf-8"))} <= rows
