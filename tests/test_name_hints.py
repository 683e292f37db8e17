"""Hints for names that are not known: the nearest one, or the remap rule that was meant."""

from __future__ import annotations

import pytest

from graphflow.errors import InvalidName
from graphflow.names import CHOICES_BOUND, Remap, did_you_mean, nearest, rule_hint


@pytest.mark.parametrize(
    ("word", "choices", "text"),
    [
        ("chater", ["chatter", "clock"], "; did you mean 'chatter'?"),
        ("xyz", ["b", "a"], "; there is a, b"),
        ("xyz", [], ""),
        ("xyz", [f"name{i}" for i in range(13)], ""),
    ],
)
def test_did_you_mean(word: str, choices: list[str], text: str) -> None:
    """A misspelt word gets the nearest choice, else a short list whole, else nothing."""
    assert did_you_mean(word, choices) == text


def test_choices_that_are_named_only_when_near() -> None:
    """They do not fill a list."""
    assert did_you_mean("/nobody", ["/add"], ["/arm/list_parameters"]) == "; there is /add"
    assert did_you_mean("/arm/list_params", ["/add"], ["/arm/list_parameters"]) == (
        "; did you mean '/arm/list_parameters'?"
    )


def test_nearest_of_very_many() -> None:
    """It looks at a limited number."""
    crowd = ["odom"] * CHOICES_BOUND
    assert nearest("cmd_vel", ["cmd_val", *crowd]) == "cmd_val"
    assert nearest("cmd_vel", [*crowd, "cmd_val"]) is None


def test_nearest_is_none_when_nothing_is_near() -> None:
    """No choice is better than a wild one."""
    assert nearest("cmd_vel", iter(["cmd_val", "odom"])) == "cmd_val"
    assert nearest("cmd_vel", ["odom", "tf"]) is None


@pytest.mark.parametrize(
    ("rule", "meant"),
    [
        ("turtle1:=turtle2", "turtle1/cmd_vel:=turtle2/cmd_vel"),
        ("/turtle1:=/turtle2/", "turtle1/cmd_vel:=/turtle2/cmd_vel"),
        ("/arm:=/leg", "/arm/left/pose:=/leg/left/pose"),
        ("turtle:=turtle2", ""),
        ("/:=/turtle2", ""),
        ("pose:=other", ""),
    ],
)
def test_rules_of_the_first_part_of_names(rule: str, meant: str) -> None:
    """The rule that was meant has a whole name."""
    match, _, replacement = rule.partition(":=")
    found = rule_hint(match, replacement, ["pose", "turtle1/cmd_vel", "turtle1/pose", "/arm/left/pose"])
    assert found == (f"; a rule has whole names: {meant}" if meant else "")


@pytest.mark.parametrize(
    ("rule", "hint"),
    [
        ("ns:=/turtle1", "; did you mean __ns:=/turtle1?"),
        ("name:=my", "; did you mean __node:=my?"),
        ("node:=my", "; did you mean __node:=my?"),
        ("/output:=pose", "; it is the other way round, from the node's name: pose:=/output"),
        ("x:=arm/left/pose", "; it is the other way round, from the node's name: arm/left/pose:=x"),
        ("/turtle1/pose:=pose", "; it is the other way round, from the node's name: pose:=/turtle1/pose"),
        ("pos:=pose", ""),
    ],
)
def test_rules_with_another_meaning(rule: str, hint: str) -> None:
    """The keys of a node's own name lack their underscores, or the sides are exchanged; a misspelt one is not."""
    match, _, replacement = rule.partition(":=")
    assert rule_hint(match, replacement, ["pose", "/arm/left/pose"]) == hint


def test_a_misspelt_key() -> None:
    """The meaning counts more than the likeness."""
    with pytest.raises(InvalidName, match="did you mean '__ns:=/turtle1'"):
        Remap.parse("__namespace:=/turtle1")
