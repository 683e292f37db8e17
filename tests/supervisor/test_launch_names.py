"""The names of ROS's launch packages."""

from __future__ import annotations

from importlib import import_module

import pytest

from graphflow.supervisor.launch_names import NAMES
from graphflow.supervisor.launch_stand_ins import PACKAGES, Context, Said, StandIns


@pytest.mark.parametrize("module", NAMES)
def test_a_star_brings_them(module: str) -> None:
    """Each is something that remembers what it is called with, or a context."""
    assert module.partition(".")[0] in PACKAGES
    finder = StandIns()
    spec = finder.find_spec(module)
    assert spec is not None
    made = finder.create_module(spec)
    assert made.__all__ == NAMES[module].split()
    assert import_module("graphflow.supervisor.launch_service")  # where one of them is
    assert all(issubclass(getattr(made, name), (Said, Context)) for name in made.__all__)
