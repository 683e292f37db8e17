"""The fixture packages of tests/interfaces, which the library does not bundle."""

from __future__ import annotations

from functools import cache
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
def fresh_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    """Definitions are read anew in this test, which changes where they come from; after it, all is as it was before.

    To forget them would not do: other tests hold classes that would then be made a second time.
    """
    for name, memory in vars(registry).copy().items():
        if hasattr(memory, "cache_clear"):
            monkeypatch.setattr(registry, name, cache(memory.__wrapped__))
