"""Advice on `input()` without a terminal."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from graphflow.rclpy.hints.lookup import hint
from graphflow.runtime.mistakes.errors import no_terminal
from graphflow.runtime.mistakes.errors.python_errors import remark_on

ENDED = EOFError("EOF when reading a line")


@contextmanager
def standard_input(file: str) -> Iterator[None]:
    """Let the block's standard input be another file."""
    former, opened = os.dup(0), os.open(file, os.O_RDONLY)
    os.dup2(opened, 0)
    try:
        yield
    finally:
        os.dup2(former, 0)
        os.close(former)
        os.close(opened)


def test_a_node_of_a_graph() -> None:
    """Its standard input is /dev/null: the error says where there is a terminal, to both APIs in their words."""
    with standard_input(os.devnull):
        remark = remark_on(ENDED)
        assert remark.startswith("a node of a graph has no terminal: start it by itself, in a terminal of its own")
        assert remark.endswith("with graphflow run, and read with await self.offload(input)")
        assert hint(ENDED).endswith("with graphflow run")


def test_input_that_has_ended() -> None:
    """A file or a pipe ends sometime, and the program expects it."""
    with standard_input(no_terminal.__file__):
        assert remark_on(ENDED) == hint(ENDED) == ""


@pytest.mark.parametrize("error", [EOFError(), EOFError("marshal data too short")])
def test_other_ends(error: EOFError) -> None:
    """Of files and connections."""
    with standard_input(os.devnull):
        assert remark_on(error) == hint(error) == ""
