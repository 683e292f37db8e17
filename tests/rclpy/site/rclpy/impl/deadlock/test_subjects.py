"""A node of rclpy's, as the reading of its source sees it."""

from __future__ import annotations

from graphflow.deadlock.closed_world.wakers import entries_of
from rclpy.impl.deadlock.subjects import Subject
from rclpy.node import Node


def test_what_its_executor_calls(node: Node) -> None:
    """By their names; what is none of a method's counts as a lambda."""
    subject = Subject(node, ["tick", "/service"])
    assert (subject.instance, subject.full_name) == (node, "/node")
    assert entries_of(subject) == {"tick", "<lambda>"}  # type: ignore[arg-type]
    assert entries_of(Subject(node)) == set()  # type: ignore[arg-type]
