"""The table of ROS 2's commands is what the command tree has."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

import click
import pytest

from graphflow.cli.main import cli
from tests.conftest import PROJECT

HIDDEN = {"launch": "launch start"}
"""Where the flags of a verb are that is a group, too."""


class Row(NamedTuple):
    verb: str
    flag: str
    state: str
    how: str


def rows() -> Iterator[Row]:
    text = (PROJECT / "docs" / "ros2-cli.md").read_text(encoding="utf-8")
    for cells in re.findall(r"^\| `([^`]+)` \| (?:`([^`]+)`)? ?\| ([^|]+) \| (.*) \|$", text, re.MULTILINE):
        yield Row(*(cell.strip() for cell in cells))


def command(words: str) -> click.Command | None:
    found: click.Command | None = cli
    for word in words.split():
        found = found.get_command(click.Context(cli), word) if isinstance(found, click.Group) else None
    return found


def flags(found: click.Command) -> set[str]:
    return {word for p in found.params if isinstance(p, click.Option) for word in (*p.opts, *p.secondary_opts)}


def test_the_table_is_read() -> None:
    """All of it: ROS 2 has some hundred verbs, and more flags."""
    table = list(rows())
    assert len(table) > 250
    assert {row.state for row in table} == {"done", "differs", "not done", "not needed"}
    assert len({(row.verb, row.flag) for row in table}) == len(table)


@pytest.mark.parametrize("row", list(rows()), ids=lambda row: f"{row.verb} {row.flag}".strip())
def test_a_row(row: Row) -> None:
    """What is done is there, what is not is not; what differs says how."""
    found = command(HIDDEN.get(row.verb, row.verb))
    if row.flag:
        assert found is not None
        assert (row.flag in flags(found)) == (row.state == "done")
    elif row.state == "done":
        assert found is not None
    if row.state == "differs":
        assert row.how
    if row.state == "not done" and not row.flag:
        assert found is None
