"""The tree of frames."""

from __future__ import annotations

import math
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


def tree(parents: dict[str, tuple[str, Pose]]) -> Frames:
    """Frames with one pose at 1 s, each below its parent."""
    out = Frames(kept=10 * S)
    for frame, (parent, pose) in parents.items():
        out.put(frame, parent, S, pose, is_static=False)
    return out


RIGHT, UP = Pose((1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), Pose((0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))
TREES = {
    "i": {"b": ("a", RIGHT), "c": ("b", RIGHT)},
    "y": {"b": ("a", RIGHT), "c": ("b", RIGHT), "d": ("b", UP), "e": ("d", UP)},
    "v": {"b": ("a", RIGHT), "c": ("b", RIGHT), "f": ("a", UP), "g": ("f", UP)},
}


@pytest.mark.parametrize(
    ("shape", "target", "source", "place"),
    [
        *(("i", "a", "b", (1, 0)), ("i", "b", "a", (-1, 0)), ("i", "a", "c", (2, 0)), ("i", "c", "a", (-2, 0))),
        *(("v", "a", "g", (0, 2)), ("v", "b", "f", (-1, 1)), ("v", "c", "f", (-2, 1)), ("v", "g", "c", (2, -2))),
        *(("v", "b", "g", (-1, 2)), ("v", "f", "c", (2, -1)), ("v", "c", "g", (-2, 2)), ("v", "g", "a", (0, -2))),
        *(("y", "a", "d", (1, 1)), ("y", "c", "d", (-1, 1)), ("y", "a", "e", (1, 2)), ("y", "e", "c", (1, -2))),
        *(("y", "b", "e", (0, 2)), ("y", "c", "e", (-1, 2)), ("y", "d", "c", (1, -1)), ("y", "e", "a", (-1, -2))),
    ],
)
@pytest.mark.parametrize("stamp", [0, S])
def test_the_trees_of_tf2s_own_tests(shape: str, target: str, source: str, place: tuple[int, int], stamp: int) -> None:
    """The places are those that tf2 tests for. Source: geometry2, test_tf2/test/buffer_core_test.cpp."""
    pose, found = tree(TREES[shape]).find(target, source, stamp)
    assert pose.translation == pytest.approx((*place, 0.0), abs=1e-9)
    assert pose.rotation == pytest.approx((0, 0, 0, 1), abs=1e-9)
    assert found == S


HALF = math.sqrt(2) / 2
RING = [(HALF - 1, HALF), (-1, 1), (-1 - HALF, HALF), (-2, 0), (-1 - HALF, -HALF), (-1, -1), (HALF - 1, -HALF), (0, 0)]
"""Places of b to i in a: a circle of radius 1, in steps of 45 degrees."""


@pytest.mark.parametrize("step", range(1, 9))
def test_the_ring_of_tf2s_own_tests(step: int) -> None:
    """Eight frames, each turned by 45 degrees in the one before, lead around a circle. Source: as above, `ring_45`."""
    link = Pose((HALF - 1, HALF, 0.0), from_rpy(0.0, 0.0, math.pi / 4))
    names = "abcdefghi"
    frames = tree({names[i + 1]: (names[i], link) for i in range(8)})
    pose, _ = frames.find("a", names[step], S)
    assert pose.translation == pytest.approx((*RING[step - 1], 0.0), abs=1e-9)
    angle = step * math.pi / 8
    sign = math.copysign(1.0, pose.rotation[3] * math.cos(angle) + pose.rotation[2] * math.sin(angle))
    assert [sign * part for part in pose.rotation] == pytest.approx([0, 0, math.sin(angle), math.cos(angle)], abs=1e-9)
    back, _ = frames.find(names[step], "a", S)
    assert back.of(pose).translation == pytest.approx((0, 0, 0), abs=1e-9)
