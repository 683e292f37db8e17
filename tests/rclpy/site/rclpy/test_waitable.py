"""Waitables."""

from __future__ import annotations

from typing import Any

import pytest

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.waitable import NumberOfEntities, Waitable
from tests.rclpy.conftest import Spinner


class Counter(Waitable):
    """Ready twice."""

    def __init__(self) -> None:
        super().__init__(ReentrantCallbackGroup())
        self.left, self.done = 2, list[int]()

    def is_ready(self, wait_set: Any) -> bool:
        return self.left > 0

    def take_data(self) -> int:
        self.left -= 1
        return self.left

    async def execute(self, taken_data: int) -> None:
        self.done.append(taken_data)


def test_it_is_taken_and_executed_while_it_is_ready(node: Node, spin: Spinner) -> None:
    """As long as a node has it."""
    counter = Counter()
    node.add_waitable(counter)
    spin(lambda: counter.done == [1, 0])
    node.remove_waitable(counter)
    counter.left = 1
    spin.executor.spin_once(timeout_sec=0)
    assert counter.done == [1, 0]


def test_what_a_subclass_must_say_is_asked_for() -> None:
    """By an error."""
    waitable = Waitable(ReentrantCallbackGroup())
    for ask in (waitable.take_data, waitable.get_num_entities, lambda: waitable.is_ready(None)):
        with pytest.raises(NotImplementedError, match="subclass"):
            ask()


def test_room_in_wait_sets_is_added_up() -> None:
    """By kind."""
    total = NumberOfEntities(1, 2) + NumberOfEntities(num_timers=3)
    total += NumberOfEntities(num_subs=1)
    assert repr(total) == "NumberOfEntities(2, 2, 3, 0, 0, 0)"
