"""Fixtures of the supervisor's tests."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.supervisor.running import make_project


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A user's own project, with nodes that misbehave."""
    return make_project(tmp_path / "lab")
