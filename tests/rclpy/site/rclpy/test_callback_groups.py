"""Callback groups."""

from __future__ import annotations

import pytest

from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup


class Entity:
    """Something with a callback."""


def test_in_an_exclusive_group_one_runs_at_a_time() -> None:
    """Until it has ended, which only itself can say."""
    group, one, other = MutuallyExclusiveCallbackGroup(), Entity(), Entity()
    assert group.can_execute(one)
    assert group.beginning_execution(one)
    assert not group.can_execute(other)
    assert not group.beginning_execution(other)
    group.ending_execution(other)
    assert not group.can_execute(one)
    group.ending_execution(one)
    assert group.can_execute(other)


def test_in_a_reentrant_group_all_run() -> None:
    """The same callback several times."""
    group, one = ReentrantCallbackGroup(), Entity()
    assert group.beginning_execution(one)
    assert group.can_execute(one)
    assert group.beginning_execution(one)
    group.ending_execution(one)


def test_a_group_knows_its_entities_as_long_as_they_are() -> None:
    """And keeps none alive; what decides is for subclasses."""
    group, one = CallbackGroup(), Entity()
    group.add_entity(one)
    assert group.has_entity(one)
    assert not group.has_entity(Entity())
    del one
    assert len(group.entities) == 0
    for decide in (group.can_execute, group.beginning_execution, group.ending_execution):
        with pytest.raises(NotImplementedError):
            decide(None)
