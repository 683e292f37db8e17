"""The fixture packages of tests/interfaces, which the library does not bundle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from graphflow.msgs import registry

if TYPE_CHECKING:
    from collections.abc import Iterator

INTERFACES = Path(__file__).parent.parent / "interfaces"


@pytest.fixture(scope="package", autouse=True)
def fixture_interfaces() -> Iterator[None]:
    """Lets the registry find them while these tests run."""
    registry.add_root(INTERFACES)
    yield
    registry._roots.remove(INTERFACES)


@pytest.fixture
def fresh_registry() -> Iterator[None]:
    """Definitions are read anew in this test, and again after it: it changes where they come from."""
    registry.forget()
    yield
    registry.forget()
