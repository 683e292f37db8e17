"""What the tests of deadlocks between processes share."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Machine
from tests.graphs.lab import Lab


@pytest.fixture
def lab(machine: Machine, tmp_path: Path) -> Lab:
    """A project on a machine of its own."""
    return Lab(machine, tmp_path / "lab")
