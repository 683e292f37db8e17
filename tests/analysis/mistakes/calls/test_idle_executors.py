"""Executors that nothing spins."""

from __future__ import annotations

import ast
from textwrap import indent

import pytest

from graphflow.analysis.mistakes.calls.idle_executors import idle_executors

MADE = "executor = MultiThreadedExecutor()\nexecutor.add_node(node)\n"


def found(body: str) -> list[tuple[int, str]]:
    return list(idle_executors(ast.parse(f"def main():\n{indent(body, '    ')}")))


def test_a_spin_without_the_executor() -> None:
    """The call is told with the executor that it needs."""
    told = "rclpy.spin does not use the MultiThreadedExecutor in executor: write rclpy.spin(node, executor)"
    assert found(f"{MADE}rclpy.spin(node)\nexecutor.shutdown()") == [(4, told)]


def test_an_executor_without_nodes() -> None:
    """Its spin is told."""
    body = "executor = MultiThreadedExecutor(num_threads=2)\nexecutor.spin()\nexecutor.shutdown()"
    assert found(body) == [(3, "executor has no node: write executor.add_node(...) before it spins")]


@pytest.mark.parametrize(
    "body",
    [
        "executor = MultiThreadedExecutor()\nadd_all(executor)\nexecutor.spin()",
        "executor = MultiThreadedExecutor()\nnode.executor = executor\nexecutor.spin()",
        "executor = MultiThreadedExecutor()\nexecutor.create_task(work)\nexecutor.spin()",
        f"{MADE}executor.spin()\nrclpy.spin(node)",
        f"{MADE}rclpy.spin(node, executor)",
        f"{MADE}rclpy.spin(node, executor=executor)",
        f"{MADE}Thread(target=executor.spin).start()\nrclpy.spin(node)",
        "executor = ThreadPoolExecutor()\nrclpy.spin(node)",
        "rclpy.spin(node)",
    ],
)
def test_executors_that_are_used(body: str) -> None:
    """Nothing is told of them, nor of pools."""
    assert found(body) == []
