#!/usr/bin/env python3
"""Draw the tree of frames in the terminal, and into a Graphviz file. Source: tf2_tools view_frames."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import yaml
from tf2_ros import Buffer, TransformListener

import rclpy
from graphflow.tf.text import tree
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.utilities import remove_ros_args


class Frame(NamedTuple):
    """A frame, and the statistics of its transforms."""

    name: str
    parent: str
    about: str


def frames(text: str) -> list[Frame]:
    """Read the frames from the text of `Buffer.all_frames_as_yaml`."""
    found = []
    for name, said in yaml.load(text, yaml.BaseLoader).items():  # noqa: S506 - it makes texts of everything: `on`, `007`
        rate, seconds = float(said["rate"]), float(said["buffer_length"])
        is_static = float(said["most_recent_transform"]) == float(said["oldest_transform"]) == 0.0 or rate == 10000.0
        about = "static" if is_static else f"{rate:.1f} Hz, over {seconds:.1f} s"
        found.append(Frame(name, said["parent"], about))
    return found


def drawn(known: list[Frame]) -> str:
    """Draw the tree, or the trees, as lines."""
    return "\n".join(tree({f.name: f.parent for f in known}, {f.name: f.about for f in known}))


def graphviz(known: list[Frame]) -> str:
    """Convert the frames to Graphviz."""

    def quoted(text: str) -> str:
        return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'

    arrows = [f"{quoted(f.parent)} -> {quoted(f.name)} [label={quoted(f.about)}];\n" for f in known]
    return f"digraph G {{\n{''.join(arrows)}}}\n"


def main() -> None:
    """Run the program."""
    rclpy.init()
    parser = argparse.ArgumentParser("view_frames", description="Draw the tree of frames.")
    parser.add_argument("--wait-time", "-t", type=float, default=5.0, help="seconds to listen (default 5)")
    parser.add_argument("--output", "-o", help="the file's name without its suffix (default frames_ and the time)")
    found = parser.parse_args(remove_ros_args(sys.argv)[1:])
    node = Node("view_frames")
    buffer = Buffer()
    TransformListener(buffer, node)
    node.get_logger().info(f"Listening to tf data for {found.wait_time} seconds...")
    until = time.monotonic() + found.wait_time
    try:
        while (left := until - time.monotonic()) > 0:
            rclpy.spin_once(node, timeout_sec=left)
    except (KeyboardInterrupt, ExternalShutdownException):
        return
    known = frames(buffer.all_frames_as_yaml())
    if not known:
        sys.exit("no frames: nothing was published on /tf or /tf_static in that time")
    sys.stdout.write(f"{drawn(known)}\n")
    name = found.output or time.strftime("frames_%Y-%m-%d_%H.%M.%S")
    try:
        Path(f"{name}.gv").write_text(graphviz(known), encoding="utf-8")
    except OSError as error:
        sys.exit(f"error: {error.filename} cannot be written: {error.strerror}")
    if shutil.which("dot") is None:
        sys.stdout.write(f"{name}.gv; for a PDF, install Graphviz: dot -Tpdf -O {name}.gv\n")
        return
    drawing = subprocess.run(["dot", "-Tpdf", f"{name}.gv", "-o", f"{name}.pdf"], check=False)
    sys.stdout.write(f"{name}.gv\n" if drawing.returncode else f"{name}.gv\n{name}.pdf\n")


if __name__ == "__main__":
    main()
