"""Times and durations in whole nanoseconds."""

from __future__ import annotations

import re
import warnings
from typing import cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.msgs.builtin_interfaces.msg import Duration as DurationMessage
from graphflow.msgs.builtin_interfaces.msg import Time as TimeMessage
from graphflow.times import NANOSECONDS, Duration, Time, ago, seconds_in, to_ns


@pytest.mark.parametrize(
    ("seconds", "nanoseconds"),
    [(0, 0), (1, NANOSECONDS), (0.1, 100_000_000), (-0.5, -500_000_000), (1e-9, 1), (4e-10, 0), (6e-10, 1)],
)
def test_seconds_round_to_the_nearest_nanosecond(seconds: float, nanoseconds: int) -> None:
    """Seconds become whole nanoseconds, rounded to nearest, with their sign."""
    assert to_ns(seconds) == nanoseconds
    assert Duration.of(seconds) == Duration(nanoseconds)


@pytest.mark.parametrize(
    ("nanoseconds", "sec", "nanosec"),
    [(0, 0, 0), (1, 0, 1), (1_500_000_000, 1, 500_000_000), (-1, -1, 999_999_999), (-1_000_000_000, -1, 0)],
)
def test_the_message_fields_round_down(nanoseconds: int, sec: int, nanosec: int) -> None:
    """`sec` is rounded down, so that `nanosec` is never negative, as in builtin_interfaces."""
    for value in (Duration(nanoseconds), Time(nanoseconds)):
        assert (value.sec, value.nanosec) == (sec, nanosec)


@settings(derandomize=True, deadline=None)
@given(st.integers(-(2**62), 2**62))
def test_the_message_fields_lose_nothing(nanoseconds: int) -> None:
    """Seconds and nanoseconds of the message add up to the value."""
    for value in (Duration(nanoseconds), Time(nanoseconds)):
        assert value.sec * NANOSECONDS + value.nanosec == nanoseconds
        assert 0 <= value.nanosec < NANOSECONDS


def test_seconds_are_floats() -> None:
    """A value in seconds is a float, of either sign."""
    assert (Time(1_500_000_000).seconds, Duration(-250_000_000).seconds) == (1.5, -0.25)


def test_a_time_and_a_duration_are_a_time() -> None:
    """A point in time moves by a span, forwards and backwards."""
    moved = Time(5) + Duration(-7)
    assert (type(moved), moved.nanoseconds) == (Time, -2)


def test_two_times_are_not_added() -> None:
    """The sum of two points in time means nothing and is refused."""
    with pytest.raises(TypeError):
        Time(1) + Time(2)  # type: ignore[operator]


def test_the_span_between_two_times() -> None:
    """How long after another time one is, negative when it is before."""
    assert Time(5) - Time(7) == Duration(-2)
    assert Time(5) - Duration(7) == Time(-2)
    assert Duration(5) - Duration(7) == -Duration(2)
    assert Duration(5) + Duration(7) == Duration(12)
    assert type(Time(7) - Time(5)) is Duration


def test_times_are_ordered() -> None:
    """Times and durations compare by their nanoseconds, the sign included."""
    assert sorted([Time(3), Time(-1), Time(2)]) == [Time(-1), Time(2), Time(3)]
    assert Duration(-1) < Duration(0)


def test_large_times_stay_exact() -> None:
    """Today's date in nanoseconds, which a float cannot hold, is exact."""
    now = Time(1_700_000_000_123_456_789)
    assert ((now + Duration(1)) - now).nanoseconds == 1
    assert (now.sec, now.nanosec) == (1_700_000_000, 123_456_789)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (-1.0, "0s"),
        (0.9, "0s"),
        (59.9, "59s"),
        (60.0, "1m00s"),
        (3599.0, "59m59s"),
        (3600.0, "1h00m"),
        (90000.0, "25h00m"),
    ],
)
def test_spans_for_people(seconds: float, text: str) -> None:
    """In seconds, then minutes, then hours, and never less than none."""
    assert ago(seconds) == text


@pytest.mark.filterwarnings("ignore:one of these two times is simulated")
@settings(derandomize=True, deadline=None)
@given(st.integers(0, 2**60), st.integers(0, 2**60))
def test_messages_stand_in_place_of_times(one: int, other: int) -> None:
    """Whichever side they are on, and on both."""
    a, b = Time(one), Time(other)
    stamp_a, stamp_b = (TimeMessage(sec=t.sec, nanosec=t.nanosec) for t in (a, b))
    assert a - stamp_b == stamp_a - b == stamp_a - stamp_b == a - b
    assert (a < stamp_b) is (stamp_a < b) is (stamp_a < stamp_b) is (a < b)
    assert (a >= stamp_b) is (stamp_a >= b) is (stamp_a >= stamp_b) is (a >= b)
    assert Time.from_msg(stamp_a) == a
    assert (a == stamp_b) is (stamp_a == b) is (stamp_a == stamp_b) is (a == b)
    assert a == stamp_a == a


@settings(derandomize=True, deadline=None)
@given(st.integers(-(2**60), 2**60), st.integers(-(2**60), 2**60))
def test_messages_stand_in_place_of_durations(one: int, other: int) -> None:
    """They add to times as well."""
    a, b = Duration(one), Duration(other)
    fields_a, fields_b = (DurationMessage(sec=d.sec, nanosec=d.nanosec) for d in (a, b))
    assert a + fields_b == fields_a + b == fields_a + fields_b == a + b
    assert a - fields_b == fields_a - b == fields_a - fields_b == a - b
    assert (a < fields_b) is (fields_a < b) is (fields_a < fields_b) is (a < b)
    assert Time(5) + fields_a == Time(5) + a
    assert Time(5) - fields_a == Time(5) - a
    assert -fields_a == -a
    assert Duration.from_msg(fields_a) == a
    assert (a == fields_b) is (fields_a == b) is (a == b)
    assert a == fields_a == a


def test_stamps_and_spans_do_not_mix() -> None:
    """As times and durations do not."""
    with pytest.raises(TypeError):
        TimeMessage(sec=1) + TimeMessage(sec=2)  # type: ignore[operator]
    with pytest.raises(TypeError):
        Duration(1) - TimeMessage(sec=2)  # type: ignore[operator]
    with pytest.raises(TypeError):
        assert TimeMessage(sec=1) < DurationMessage(sec=2)  # type: ignore[operator]
    assert Time(1) != Duration(1)
    assert len({Time(1), Time(1), Duration(1)}) == 2


@pytest.mark.parametrize(("kind", "way"), [(Time, "self.clock.now(), or"), (Duration, "Duration.of(seconds)")])
def test_fractions_of_a_nanosecond_are_refused(kind: type[Time | Duration], way: str) -> None:
    """They are seconds, by mistake; whole numbers of any kind are taken."""
    with pytest.raises(TypeError, match=re.escape(f"{kind.__name__} takes whole nanoseconds, not 1.5; write {way}")):
        kind(cast("int", 1.5))
    assert kind(cast("int", np.int64(5))).nanosec == 5


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("500ms", "0.5"),
        ("1.5 s", "1.5"),
        ("2min", "120"),
        ("1h", "3600"),
        ("-3 us", "-0.000003"),
        ("2", ""),
        ("2 Hz", ""),
        ("ms", ""),
        ("10 s more", ""),
    ],
)
def test_durations_with_a_unit(text: str, seconds: str) -> None:
    """They are converted to the number to write; other texts are not."""
    assert seconds_in(text) == seconds


@pytest.mark.parametrize("stamp", [Time(3 * NANOSECONDS), TimeMessage(sec=3)])
def test_times_of_two_clocks(stamp: Time | TimeMessage) -> None:
    """The line of user code gets a warning; a time of 0 stands for none."""
    with pytest.warns(RuntimeWarning, match="one of these two times is simulated, and the other is not") as caught:
        age = Time(1_800_000_000 * NANOSECONDS) - stamp
    assert caught[0].filename == __file__
    assert age.sec == 1_799_999_997
    with pytest.warns(RuntimeWarning, match="set use_sim_time") as caught:
        assert (stamp - Time(1_800_000_000 * NANOSECONDS)).sec == -1_799_999_997
    assert caught[0].filename == __file__
    with warnings.catch_warnings(action="error"):
        assert (Time(1_800_000_000 * NANOSECONDS) - Time(0)).sec == 1_800_000_000
        assert (Time(1_800_000_000 * NANOSECONDS) - Time(1_300_000_000 * NANOSECONDS)).sec == 500_000_000
