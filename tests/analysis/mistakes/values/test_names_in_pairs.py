"""Names that are looked for among pairs."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.names_in_pairs import names_in_pairs

CALL = "self.get_topic_names_and_types()"


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (f"if '/x' in {CALL}: pass", f"write '/x' in dict({CALL})"),
        (f"topics = {CALL}\nwhile '/x' not in topics: pass", "write '/x' not in dict(topics)"),
        ("ok = f'/{n}' in self.get_node_names_and_namespaces()", "dict(self.get_node_names_and_namespaces())"),
    ],
)
def test_a_name_among_pairs(code: str, told: str) -> None:
    """The sentence has the mapping."""
    [(_, text)] = names_in_pairs(ast.parse(code))
    assert told in text


@pytest.mark.parametrize(
    "code",
    [
        f"if '/x' in dict({CALL}): pass",
        f"if '/x' in [name for name, _ in {CALL}]: pass",
        f"if pair in {CALL}: pass",
        f"topics = {CALL}\ntopics = dict(topics)\nok = '/x' in topics",
        "ok = '/x' in self.get_node_names()",
    ],
)
def test_names_among_names(code: str) -> None:
    """Names, and pairs among pairs, are left alone."""
    assert not list(names_in_pairs(ast.parse(code)))
