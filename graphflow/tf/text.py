"""Transforms and trees of frames as text: the output of ROS's tf2_echo and tf2_monitor, and a drawn tree."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from graphflow.tf.info import FrameInfo
from graphflow.tf.poses import AXES, rotate, to_rpy
from graphflow.tf.transform import Transform
from graphflow.times import SIMULATED


def described(transform: Transform) -> str:
    """Format a transform as lines, as tf2_echo does."""
    translation, rotation = transform.pose
    turns = to_rpy(rotation)
    columns = [*(rotate(rotation, axis) for axis in AXES), translation]
    rows = [*zip(*columns, strict=True), (0.0, 0.0, 0.0, 1.0)]
    return "\n".join(
        [
            f"At time {transform.stamp.sec}.{transform.stamp.nanosec:09}",
            f"- Translation: {_vector(translation)}",
            f"- Rotation: in Quaternion (xyzw) {_vector(rotation)}",
            f"- Rotation: in RPY (radian) {_vector(turns)}",
            f"- Rotation: in RPY (degree) {_vector([math.degrees(turn) for turn in turns])}",
            "- Matrix:",
            *("".join(f" {number:z6.3f}" for number in row) for row in rows),
        ]
    )


def _vector(numbers: Iterable[float]) -> str:
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


def tree(parents: Mapping[str, str], remarks: Mapping[str, str]) -> list[str]:
    """Draw the tree of frames, or the trees, as lines.

    Args:
        parents: The parent of each frame that has one.
        remarks: The text behind each frame's name.
    """
    lines: list[str] = []
    drawn: set[str] = set()

    def draw(parent: str, before: str) -> None:
        below = sorted(frame for frame, above in parents.items() if above == parent and frame not in drawn)
        drawn.update(below)  # each frame once, also where they form a loop
        for frame in below:
            is_last = frame == below[-1]
            remark = f"   ({remarks[frame]})" if remarks.get(frame) else ""
            lines.append(f"{before}{'└── ' if is_last else '├── '}{frame}{remark}")
            draw(frame, f"{before}{'    ' if is_last else '│   '}")

    roots = sorted({*parents.values()} - parents.keys())
    for root in roots or sorted(parents.values())[:1]:
        lines.append(root)
        draw(root, "")
    return lines


def remark(info: FrameInfo, age: float) -> str:
    """Describe a frame's transforms behind its name: `30.0 Hz, 0.02 s old, by /odometry`.

    Args:
        age: Seconds since the time of the newest transform.
    """
    sender = f"by {info.publisher}" if info.publisher else "its publisher has ended"
    if info.is_static:
        return f"static, {sender}"
    rate = f"{info.rate:.1f} Hz, " if info.rate else ""
    when = f"{age:.2f} s old" if abs(age) < SIMULATED else f"at {info.newest.seconds:.2f} s"
    return f"{rate}{when}, {sender}"


def monitored(infos: Sequence[FrameInfo], chain: Sequence[str], delays: Sequence[float]) -> str:
    """Format delays of frames and publishers as tf2_monitor does.

    Args:
        chain: The frames between two that are monitored; empty for all frames.
        delays: Seconds since the latest time common to the chain, at several moments.
    """
    lines = [f"RESULTS: for {chain[0]} to {chain[-1]}" if chain else "RESULTS: for all Frames"]
    if chain:
        lines.append(f"Chain is: {' -> '.join(chain)}")
    if delays:
        lines.append(f"Net delay     avg = {sum(delays) / len(delays):.6g}: max = {max(delays):.6g}")
    lines += ["", "Frames:"]
    shown = [info for info in infos if not chain or info.frame in chain]
    for info in shown:
        times = "static" if info.is_static else f"Average Delay: {info.delay:.6g}, Max Delay: {info.longest_delay:.6g}"
        lines.append(f"Frame: {info.frame}, published by {info.publisher or '<ended>'}, {times}")
    lines += ["", "All Broadcasters:"]
    for publisher in sorted({info.publisher for info in infos}):
        own = [info for info in infos if info.publisher == publisher]
        rate = sum(info.rate for info in own)
        moving = [info for info in own if not info.is_static]
        delay = sum(info.delay for info in moving) / len(moving) if moving else 0.0
        longest = max((info.longest_delay for info in moving), default=0.0)
        name = publisher or "<ended>"
        lines.append(f"Node: {name} {rate:.6g} Hz, Average Delay: {delay:.6g} Max Delay: {longest:.6g}")
    return "\n".join(lines)
