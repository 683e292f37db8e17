"""The tree of frames."""

from __future__ import annotations

import random

import numpy as np
import pytest
from transforms3d import quaternions

import graphflow.tf.frames
from graphflow.errors import ExtrapolationError, FrameLoop, TransformError, UnconnectedFrames, UnknownFrame
from graphflow.tf.frames import Frames, seconds
from graphflow.tf.poses import Pose, from_rpy
from tests.cases import count

S = 10**9


def matrix(pose: Pose) -> np.ndarray:
    """Convert a pose to a 4x4 matrix, by the textbook's formula and not by the code under test."""
    out = np.eye(4)
    x, y, z, w = pose.rotation
    out[:3, :3] = quaternions.quat2mat((w, x, y, z))
    out[:3, 3] = pose.translation
    return out


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


@pytest.mark.parametrize(
    ("target", "source", "stamp", "kind", "text"),
    [
        ("map", "lasre", 0, UnknownFrame, "map -> lasre: there is no frame 'lasre'; did you mean 'laser'?; the known"),
        ("mpa", "laser", 0, UnknownFrame, "mpa -> laser: there is no frame 'mpa'; did you mean 'map'?"),
        ("map", "xyz", 0, UnknownFrame, "'xyz'; the known frames are base, laser, map, moon, odom ..."),
        (
            *("moon", "laser", 0, UnconnectedFrames),
            "moon is in the tree of sky, laser is in the tree of map, and no transform connects the two",
        ),
        ("sky", "laser", 105, UnconnectedFrames, "sky is the root of a tree, laser is in the tree of map"),
        (
            *("map", "laser", 110.8, ExtrapolationError),
            "map -> laser at 110.80 s: the newest odom -> base is 0.80 s older",
        ),
        ("laser", "map", 99, ExtrapolationError, "the oldest odom -> base kept is 1.00 s newer"),
    ],
)
def test_errors(frames: Frames, target: str, source: str, stamp: float, kind: type[TransformError], text: str) -> None:
    """Each names the frames and what separates them."""
    with pytest.raises(kind) as caught:
        x(frames, target, source, stamp)
    assert text in str(caught.value)
    assert (caught.value.target, caught.value.source) == (target, source)


def test_a_single_pose_is_not_extrapolated(frames: Frames) -> None:
    """It holds at its own time only; other chains go on."""
    frames.put("arm", "odom", 105 * S, at(-1), is_static=False)
    with pytest.raises(ExtrapolationError) as caught:
        x(frames, "odom", "arm", 106)
    found = caught.value
    assert (found.frame, found.parent) == ("arm", "odom")
    assert (found.requested_ns, found.oldest_ns, found.newest_ns) == (106 * S, 105 * S, 105 * S)
    assert x(frames, "odom", "laser", 103) == (3.5, 103)


def test_above_what_both_share_nothing_has_to_be_known(frames: Frames) -> None:
    """There, it may begin later."""
    frames.put("map", "earth", 109 * S, at(0), is_static=False)
    assert x(frames, "odom", "laser", 103) == (3.5, 103)


def test_history_ends(frames: Frames) -> None:
    """What is older than it is refused; what comes late, or again, has its place."""
    frames.put("base", "odom", 112 * S, at(12), is_static=False)
    with pytest.raises(ExtrapolationError, match="oldest odom -> base"):
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
    with pytest.raises(UnconnectedFrames):
        x(frames, "odom", "base", 0)


def test_a_loop(frames: Frames) -> None:
    """The error names all of it, at any time."""
    frames.put("map", "laser", 0, at(0), is_static=True)
    for stamp in (0, 105):
        with pytest.raises(FrameLoop, match=r"^moon -> laser: the frames form a loop: .*; let one") as caught:
            x(frames, "moon", "laser", stamp)
        circle = str(caught.value).partition("loop: ")[2].partition(";")[0].split(" -> ")
        assert circle[0] == circle[-1]
        assert sorted(circle[1:]) == ["base", "laser", "map", "odom"]


def test_nobody_can_fill_the_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither with frames nor with times; what is known goes on."""
    monkeypatch.setattr(graphflow.tf.frames, "FRAMES_BOUND", 50)
    monkeypatch.setattr(graphflow.tf.frames, "SAMPLES_BOUND", 20)
    monkeypatch.setattr(graphflow.tf.frames, "TOTAL_BOUND", 100)
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


def test_no_frame_is_known() -> None:
    """The error says so."""
    with pytest.raises(UnknownFrame, match="there is no frame 'map'; no frame is known so far"):
        Frames(1).find("map", "base", 0)


@pytest.mark.parametrize(
    ("ns", "text"),
    [(0, "0.00"), (12_300_000_000, "12.30"), (800_000_000, "0.80"), (3_400_000, "0.003"), (2, "0.000000002")],
)
def test_seconds(ns: int, text: str) -> None:
    """Small distances differ from none."""
    assert seconds(ns) == text


def test_random_trees() -> None:
    """Lookups equal products of 4x4 matrices to 1e-9, in trees of up to twelve frames."""
    dice = random.Random(7)
    for _ in range(count(300, 20_000)):
        frames, matrices = Frames(10 * S), {"f0": np.eye(4)}
        for index in range(1, dice.randint(2, 12)):
            parent, name = dice.choice(list(matrices)), f"f{index}"
            turn = from_rpy(*(dice.uniform(-3.2, 3.2) for _ in range(3)))
            pose = Pose((dice.uniform(-10, 10), dice.uniform(-10, 10), dice.uniform(-10, 10)), turn)
            frames.put(name, parent, S, pose, is_static=dice.random() < 0.3)
            matrices[name] = matrices[parent] @ matrix(pose)
        target, source = dice.choice(list(matrices)), dice.choice(list(matrices))
        found, _ = frames.find(target, source, dice.choice([0, S]))
        expected = np.linalg.inv(matrices[target]) @ matrices[source]
        assert np.allclose(matrix(found), expected, rtol=0, atol=1e-9)
