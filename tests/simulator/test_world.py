"""Descriptions of worlds; their mistakes are in test_files."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from graphflow.simulator.world import OBSTACLES_BOUND, ROBOTS_BOUND, World


def test_worlds_have_bounds() -> None:
    """Neither obstacles nor robots are without number."""
    for parts in (
        {"cylinders": [{"at": [0, 0], "radius": 1}] * (OBSTACLES_BOUND + 1)},
        {"robots": [{"name": f"r{i}"} for i in range(ROBOTS_BOUND + 1)]},
    ):
        with pytest.raises(ValidationError, match="at most"):
            World.model_validate(parts)
    assert World.model_validate({}).robots == []


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        ({"walls": [{"points": [[-2000, 0], [2000, 0]]}]}, "are these millimetres\\? 2000 mm are 2 m"),
        ({"robots": [{"at": [0, 101]}]}, r"\[0.0, 101.0\] lies beyond the end of the world, 100 m from its middle"),
        ({"robots": [{"yaw": 90}]}, "yaw is in radians; 90 degrees are 1.571"),
    ],
)
def test_what_no_world_has(parts: dict[str, object], said: str) -> None:
    """Other units than metres and radians."""
    with pytest.raises(ValidationError, match=said):
        World.model_validate(parts)
