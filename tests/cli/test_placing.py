"""Options of graphflow's that are written behind the verb."""

from __future__ import annotations

import pytest

from graphflow.cli.placing import before_the_verb, option_after_verb


@pytest.mark.parametrize(
    ("words", "option"),
    [
        ("--domain 8", "--domain"),
        ("-r a:=b --net=x.yaml", "--net"),
        ("--domains 8", None),
        ("--ros-args --domain 8", None),
        ("-- --domain 8", None),
        ("", None),
    ],
)
def test_the_option_that_is_behind(words: str, option: str | None) -> None:
    """An option after the verb is found, among the words that may be graphflow's."""
    assert option_after_verb(words.split()) == option


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ("topic list --domain 7 -t", "--domain goes before the verb: graphflow --domain 7 topic list -t"),
        ("run a --domain=7", "--domain goes before the verb: graphflow --domain=7 run a"),
        ("topic list --domain", "--domain goes before the verb: graphflow --domain topic list"),
    ],
)
def test_the_line_to_type(words: str, text: str) -> None:
    """Has the option and its value first."""
    assert before_the_verb("--domain", words.split()) == text
