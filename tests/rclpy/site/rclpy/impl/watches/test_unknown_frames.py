"""Lookups of frames that do not exist."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from geometry_msgs.msg import TransformStamped
from tf2_ros import Buffer, ExtrapolationException, LookupException

from graphflow.errors import ExtrapolationError, UnknownFrame
from rclpy.impl.watches import unknown_frames
from rclpy.time import Time


def asked(buffer: Buffer, frame: str) -> None:
    with pytest.raises(LookupException, match="does not exist"):
        buffer.lookup_transform("world", frame, Time())


def test_a_misspelt_frame_is_told_once(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not before others are known, and a while after the first lookup; with its line and the nearest frame."""
    buffer, sent = Buffer(), TransformStamped()
    monkeypatch.setattr(unknown_frames, "WARN_AFTER", 0.0)
    asked(buffer, "carot")
    sent.header.frame_id, sent.child_frame_id = "world", "carrot"
    sent.transform.rotation.w = 1.0
    buffer.set_transform(sent, "test")
    monkeypatch.setattr(unknown_frames, "WARN_AFTER", 60.0)
    asked(buffer, "carot")
    assert "carot" not in caplog.text
    monkeypatch.setattr(unknown_frames, "WARN_AFTER", 0.0)
    for _ in range(2):
        asked(buffer, "carot")
    [text] = [record.getMessage() for record in caplog.records if "carot" in record.getMessage()]
    assert text.partition(": ")[0] == f"test_unknown_frames.py:{asked.__code__.co_firstlineno + 2}"
    assert "there is no frame 'carot'; did you mean 'carrot'?; the known frames are carrot, world" in text


@pytest.mark.parametrize(("ahead", "pause", "is_told"), [(1, 0.5, True), (1, 3.0, False), (5, 0.5, False)])
def test_a_time_whose_transform_is_on_its_way(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch, ahead: int, pause: float, is_told: bool
) -> None:
    """It is told once in a series of failed lookups; not of a time far ahead, or now and then."""
    times = iter(pause * number for number in range(30))
    monkeypatch.setattr(unknown_frames, "time", SimpleNamespace(monotonic=lambda: next(times)))
    kept, newest = unknown_frames.UnknownFrames(), 10**9
    requested = newest + ahead * unknown_frames.AHEAD_NS // 2
    error = ExtrapolationError("ahead", "world", "a", "a", "world", (requested, 0, newest))
    for _ in range(30):
        kept.lookup_failed(error)
    told = [record.getMessage() for record in caplog.records if "is not there yet" in record.getMessage()]
    assert len(told) == is_told


def test_a_time_that_is_waited_for(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """A lookup with a timeout fails until the transform is there; the one that finds it ends the series."""
    times = iter(range(60))
    monkeypatch.setattr(unknown_frames, "time", SimpleNamespace(monotonic=lambda: next(times)))
    buffer, sent = Buffer(), TransformStamped()
    sent.header.frame_id, sent.child_frame_id = "world", "carrot"
    sent.transform.rotation.w = 1.0
    for second in range(20):
        sent.header.stamp.sec = second + 1
        buffer.set_transform(sent, "test")
        with pytest.raises(ExtrapolationException):
            buffer.lookup_transform("world", "carrot", Time(seconds=second + 1, nanoseconds=10**8))
        buffer.lookup_transform("world", "carrot", Time(seconds=second + 1))
    assert "is not there yet" not in caplog.text


def test_no_more_frames_are_kept_than_the_bound() -> None:
    """A program may look up ever new names."""
    kept = unknown_frames.UnknownFrames()
    for number in range(2 * unknown_frames._FRAMES_BOUND):
        kept.lookup_failed(UnknownFrame("no frame", "world", f"f{number}", f"f{number}"))
    assert len(kept._since) == unknown_frames._FRAMES_BOUND
