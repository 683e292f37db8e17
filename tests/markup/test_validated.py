"""YAML files as models."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydantic import BaseModel, ConfigDict

from graphflow.errors import GraphFileError
from graphflow.markup import source
from graphflow.markup.validated import validated


class Inner(BaseModel):
    model_config = ConfigDict(extra="forbid")
    size: int


class Outer(BaseModel):
    model_config = ConfigDict(extra="forbid")
    inner: Inner | None = None
    rows: list[Inner] = []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("inner: {size: 1, siz: 2}", "f.yaml:1:18: unknown key 'siz'; did you mean 'size'?"),
        ("rows:\n- {size: 1}\n- {sise: 2}", "f.yaml:3:4: unknown key 'sise'; did you mean 'size'?"),
        ("rows:\n- {}", "f.yaml:2:3: the key 'size' is missing"),
        ("inner: {size: x}", "f.yaml:1:15: 'x': input should be a valid integer"),
        ("other: 1", "f.yaml:1:1: unknown key 'other'; there is inner, rows"),
    ],
)
def test_mistakes(tmp_path: Path, text: str, said: str) -> None:
    """Each has its place, and the nearest key of its model."""
    (tmp_path / "f.yaml").write_text(text)
    with pytest.raises(GraphFileError) as caught:
        validated(source.read_file(tmp_path / "f.yaml", "f.yaml"), Outer)
    assert said in str(caught.value)


def test_an_empty_file(tmp_path: Path) -> None:
    """It is a model without values."""
    (tmp_path / "f.yaml").write_text("")
    assert validated(source.read_file(tmp_path / "f.yaml", "f.yaml"), Outer) == Outer()
