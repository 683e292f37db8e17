"""The fixture packages of tests/interfaces, and folders in which a test writes definitions of its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from graphflow.msgs import registry

if TYPE_CHECKING:
    from collections.abc import Iterator

INTERFACES = Path(__file__).parent.parent / "interfaces"

Save = Callable[[str, str], Path]


@pytest.fixture(scope="package", autouse=True)
def fixture_interfaces() -> Iterator[None]:
    """Lets the registry find them while these tests run."""
    registry.add_root(INTERFACES)
    yield
    registry._roots.remove(INTERFACES)


@pytest.fixture
def save(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Save:
    """`save("package/msg/Name", text)` writes a definition into a project's interfaces folder.

    What has been read stays read as long as the process lives, so every test has packages of its own.
    """
    monkeypatch.syspath_prepend(tmp_path)

    def save(name: str, text: str) -> Path:
        file = tmp_path / "interfaces" / f"{name}.{name.split('/')[1]}"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        return file

    return save


def make(name: str, **fields: Any) -> Any:
    """A message by the name of its type."""
    return registry.interface_class(name)(**fields)
