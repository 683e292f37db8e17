"""The tables of sentences."""

from __future__ import annotations

import re

import pytest

from graphflow.rclpy.hints.tables import TEXTS


@pytest.mark.parametrize(("pattern", "sentence"), TEXTS.items())
def test_sentences_have_only_groups_of_their_pattern(pattern: str, sentence: str) -> None:
    """A sentence that names another would never be shown."""
    groups = re.compile(pattern).groups
    assert sentence.format(*("x" for _ in range(groups)))
