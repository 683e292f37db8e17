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
