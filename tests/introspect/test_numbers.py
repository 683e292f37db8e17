"""Rates between two samples; invalid answers are left out."""

from __future__ import annotations

import json

import pytest

from graphflow.introspect import numbers as numbers_module
from graphflow.introspect.numbers import REPLY_BOUND, Flow, Numbers


def reply(published: int, dropped: int = 0, lag: float = 0.001) -> bytes:
    parts = {
        "publisher /pose": {"published": published},
        "publisher /rosout": {"published": 1},
        "subscription /goal": {"received": 2 * published, "dropped": dropped},
        "group main": {"limit": 1},
    }
    return json.dumps({"process": "z", "lag": lag, "nodes": {"/a": parts}}).encode()


def test_rates_and_lags() -> None:
    """By endpoint, topic and node."""
    numbers = Numbers()
    numbers.take([reply(100)], 10.0)
    assert numbers.published("/pose") is None
    numbers.take([reply(150, dropped=3, lag=0.5)], 12.0)
    assert numbers.published("/pose") == 25.0
    assert numbers.fastest("/a") == 25.0
    assert numbers.rates[Flow("/a", "subscription", "/goal")] == 50.0
    assert numbers.dropped == {Flow("/a", "subscription", "/goal"): 3}
    assert numbers.lags == {"/a": 0.5}
    assert numbers.published("/other") is None
    assert numbers.fastest("/other") is None


def test_a_node_that_was_restarted_has_no_rate_yet() -> None:
    """Its counts begin again."""
    numbers = Numbers()
    numbers.take([reply(100)], 1.0)
    numbers.take([reply(5)], 2.0)
    assert numbers.published("/pose") is None
    numbers.take([reply(15)], 3.0)
    assert numbers.published("/pose") == 10.0


@pytest.mark.parametrize(
    "bad",
    [
        b"",
        b"[]",
        b"{}",
        b'{"nodes": 3, "lag": 0}',
        b'{"nodes": {"/b": {"publisher /x": {}}}, "lag": 0}',
        b'{"nodes": {"/b": 3}, "lag": "x"}',
        b"[" * 100_000,
        b"x" * (REPLY_BOUND + 1),
    ],
)
def test_what_is_no_answer(bad: bytes) -> None:
    """The others count all the same."""
    numbers = Numbers()
    for now in (1.0, 2.0):
        numbers.take([bad, reply(int(10 * now))], now)
    assert numbers.published("/pose") == 10.0


@pytest.mark.parametrize("number", ["Infinity", "-Infinity", "NaN", "1e999", "1" + "0" * 400])
def test_numbers_that_are_none(number: str) -> None:
    """Invalid numbers do not affect the others."""
    numbers = Numbers()
    for key in ('"lag": X, "nodes": {"/a": {}}', '"lag": 0, "nodes": {"/a": {"publisher /b": {"published": X}}}'):
        numbers.take([f"{{{key.replace('X', number)}}}".encode()], 1.0)
        numbers.take([f"{{{key.replace('X', number)}}}".encode()], 2.0)


def test_answers_that_are_too_long_or_have_too_much(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first are left out, and of the others only so many endpoints are kept."""
    monkeypatch.setattr(numbers_module, "NODES_BOUND", 1)
    numbers = Numbers()
    for now in (1.0, 2.0):
        numbers.take([reply(int(10 * now))], now)
    assert list(numbers.rates) == [Flow("/a", "publisher", "/pose")]
    monkeypatch.setattr(numbers_module, "REPLY_BOUND", 10)
    numbers.take([reply(30)], 3.0)
    assert (numbers.rates, numbers.lags) == ({}, {})
