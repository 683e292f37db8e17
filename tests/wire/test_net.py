"""The tokens of links, which describe their net profiles."""

from __future__ import annotations

import pytest

from graphflow.wire.net import TOKEN_BOUND, NetToken, parse, token


def test_there_and_back() -> None:
    """Whatever the file is called; nothing in the key means several keys."""
    allow = ("/turtle1/**", "/*/pose")
    text = token(5, "abc", "/home/me/my lab/*.yaml", allow)
    assert "*" not in text
    assert parse(text) == NetToken("/home/me/my lab/*.yaml", allow)


@pytest.mark.parametrize("text", ["", "@graphflow/5/net/abc", "@graphflow/5/proc/abc/x/y", "@ros2_lv/5/net/a/b/c"])
def test_what_is_none(text: str) -> None:
    """Others are left alone."""
    assert parse(text) is None


@pytest.mark.parametrize(
    ("pattern", "name", "passes"),
    [
        ("/**", "/a/b", True),
        ("/spawn", "/spawn", True),
        ("/spawn", "/spawned", False),
        ("/turtle1/**", "/turtle1/pose", True),
        ("/turtle1/**", "/turtle1", True),
        ("/turtle1/**", "/turtle2/pose", False),
        ("/*/pose", "/turtle2/pose", True),
        ("/*/pose", "/a/b/pose", False),
    ],
)
def test_patterns(pattern: str, name: str, passes: bool) -> None:
    """They mean what they mean to Zenoh."""
    assert NetToken("lab.yaml", (pattern,)).passes(name) is passes


def test_patterns_of_strangers_cost_little() -> None:
    """Many `**` in a row would have a regular expression try for hours."""
    pattern, name = "/**" * 2000 + "/x", "/a" * 2000
    assert not NetToken("f", (pattern,)).passes(name)
    assert NetToken("f", (pattern,)).passes(f"{name}/x")
    assert NetToken("f", ("/a/**/c/*/**",)).passes("/a/b/c/c/d/e")
    assert not NetToken("f", ("/a/**/c/*",)).passes("/a/b/c")


def test_a_token_that_is_too_long() -> None:
    """It is none: reading it would take time in proportion."""
    text = token(5, "abc", "x" * TOKEN_BOUND, ())
    assert parse(text) is None
    assert parse(text[: text.rindex("/") - 100] + "/") is not None


def test_what_a_terminal_would_obey() -> None:
    """Any process may announce a profile, whose names are printed."""
    found = parse(token(5, "abc", "lab\x1b[31m.yaml", ("/a\x07",)))
    assert found == NetToken("lab\\x1b[31m.yaml", ("/a\\x07",))
