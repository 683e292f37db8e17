"""The tree of frames."""

from __future__ import annotations

import pytest
import tf2_py.frames
from tf2_py.exceptions import ConnectivityException, ExtrapolationException, LookupException, TransformException
from tf2_py.frames import Frames
from tf2_py.poses import Pose

S = 10**9


def at(x: float) -> Pose:
    return Pose((x, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@pytest.fixture
def frames() -> Frames:
    """A robot that drives from 0 to 10 m in the seconds 100 to 110, with a laser on it, on a map that is fixed."""
    out = Frames(kept=10 * S)
    for second in range(11):
        out.put("base", "odom", (100 + second) * S, at(second), is_static=False)
    out.put("laser", "base", 0, at(0.5), is_static=True)
    out.put("odom", "map", 0, at(1000), is_static=True)
    out.put("moon", "sky", 0, at(0), is_static=True)
    return out


def x(frames: Frames, target: str, source: str, stamp: float) -> tuple[float, float]:
    pose, found = frames.find(target, source, int(stamp * S))
    return pose.translation[0], found / S


def test_up_down_and_across(frames: Frames) -> None:
    """At a time, between two times, and at the latest that all have."""
    assert x(frames, "map", "laser", 103) == (1003.5, 103)
    assert x(frames, "laser", "map", 103.5) == (-1004, 103.5)
    assert x(frames, "odom", "laser", 0) == (10.5, 110)
    assert x(frames, "base", "laser", 0) == (0.5, 0)
    assert x(frames, "base", "base", 0) == (0, 110)
    assert x(frames, "map", "map", 7) == (0, 7)
    frames.put("arm", "odom", 105 * S, at(-1), is_static=False)
    assert x(frames, "arm", "base", 0) == (6, 105)


def test_what_cannot_be_had(frames: Frames) -> None:
    """With tf2's words."""
    for target, source, stamp, kind, said in (
        ("map", "lasre", 0, LookupException, '"lasre" passed to lookupTransform argument source_frame does not exist'),
        ("mpa", "laser", 0, LookupException, '"mpa" passed to lookupTransform argument target_frame does not exist'),
        ("moon", "laser", 0, ConnectivityException, "'moon' and 'laser' because they are not part of the same tree"),
        ("moon", "laser", 105, ConnectivityException, "two or more unconnected trees"),
        (
            "map",
            "laser",
            110.5,
            ExtrapolationException,
            "Lookup would require extrapolation into the future.  Requested time 110.500000 but the latest data is at "
            r"time 110.000000, when looking up transform from frame \[laser\] to frame \[map\]",
        ),
        ("laser", "map", 99, ExtrapolationException, "into the past.  Requested time 99.000000 but the earliest data"),
    ):
        with pytest.raises(kind, match=said):
            x(frames, target, source, stamp)
    frames.put("arm", "odom", 105 * S, at(-1), is_static=False)
    with pytest.raises(
        ExtrapolationException, match=r"at time 106\.000000, but only time 105\.000000 is in the buffer"
    ):
        x(frames, "odom", "arm", 106)
    assert x(frames, "odom", "laser", 103) == (3.5, 103)


def test_above_what_both_share_nothing_has_to_be_known(frames: Frames) -> None:
    """There, it may begin later."""
    frames.put("map", "earth", 109 * S, at(0), is_static=False)
    assert x(frames, "odom", "laser", 103) == (3.5, 103)


def test_history_ends(frames: Frames) -> None:
    """What is older than it is refused; what comes late, or again, has its place."""
    frames.put("base", "odom", 112 * S, at(12), is_static=False)
    with pytest.raises(ExtrapolationException, match="past"):
        x(frames, "odom", "base", 101)
    assert not frames.put("base", "odom", 101 * S, at(1), is_static=False)
    assert frames.refused == 1
    assert frames.put("base", "odom", 111 * S, at(20), is_static=False)
    assert frames.put("base", "odom", 110 * S, at(30), is_static=False)
    assert [x(frames, "odom", "base", s)[0] for s in (109, 110, 110.5, 111, 111.5)] == [9, 30, 25, 20, 16]


def test_a_frame_may_change_its_parent(frames: Frames) -> None:
    """Then each time has the parent that it had."""
    frames.put("base", "sky", 111 * S, at(0), is_static=False)
    assert x(frames, "odom", "base", 105) == (5, 105)
    assert x(frames, "moon", "laser", 0) == (0.5, 111)
    with pytest.raises(ConnectivityException):
        x(frames, "odom", "base", 0)


def test_a_loop_is_told(frames: Frames) -> None:
    """And ends."""
    frames.put("map", "laser", 0, at(0), is_static=True)
    with pytest.raises(TransformException, match="contains a loop"):
        x(frames, "moon", "laser", 105)


def test_nobody_can_fill_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither with frames nor with times; what is known goes on."""
    monkeypatch.setattr(tf2_py.frames, "FRAMES_BOUND", 50)
    monkeypatch.setattr(tf2_py.frames, "SAMPLES_BOUND", 20)
    monkeypatch.setattr(tf2_py.frames, "TOTAL_BOUND", 100)
    frames = Frames(kept=10**6 * S)
    frames.put("base", "odom", 1 * S, at(0), is_static=False)
    for i in range(100):
        frames.put(f"frame{i}", f"parent{i}", S, at(0), is_static=False)
    assert len(frames.names()) <= 51
    assert frames.refused > 50
    for i in range(100):
        frames.put("base", "odom", i * S, at(i), is_static=False)
    assert len(frames.histories["base"].stamps) == 20
    assert x(frames, "odom", "base", 99) == (99, 99)
    for name in ("frame0", "frame1", "frame2", "frame3", "frame4"):
        for i in range(40):
            frames.put(name, "parent0", i * S, at(i), is_static=False)
    assert sum(len(history.stamps) for history in frames.histories.values()) <= 100
    frames.clear()
    assert frames.names() == []
    assert frames.put("base", "odom", S, at(0), is_static=False)


def test_a_frame_that_is_not_known(frames: Frames) -> None:
    """The error has a note with the nearest of those that are."""
    names = frames.names()
    for asked, known in (
        (frames, f"the frames known so far are {', '.join(names[:5])}"),
        (Frames(1), "no frame is known"),
    ):
        with pytest.raises(LookupException) as caught:
            asked.find(f"{names[0]}x", names[1], 0)
        [note] = caught.value.__notes__
        assert note.startswith(f"note: {known}")
        assert (f"did you mean '{names[0]}'?" in note) is (asked is frames)
