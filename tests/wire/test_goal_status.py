"""The list of goals and their states, beside the generated codec of the message."""

from __future__ import annotations

from random import Random
from typing import Any

import pytest

from graphflow.errors import DecodeError
from graphflow.msgs import registry
from graphflow.msgs.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from graphflow.msgs.builtin_interfaces.msg import Time
from graphflow.msgs.unique_identifier_msgs.msg import UUID
from graphflow.wire.goal_status import GoalStates, states_in

CODEC = registry.codec("action_msgs/msg/GoalStatusArray")


@pytest.mark.parametrize("seed", range(20))
def test_any_goals(seed: int) -> None:
    """After any changes the bytes are those of the message that says the same, and a client finds its goals in them."""
    random = Random(seed)
    states, there = GoalStates(), dict[bytes, tuple[int, int]]()
    for _ in range(60):
        match random.choice(["add", "add", "put", "remove"]):
            case "add":
                goal_id = random.choice([random.randbytes(16), bytes(15) + random.randbytes(1)])
                if goal_id not in there:
                    there[goal_id] = random.randrange(2**31) * 10**9 + random.randrange(10**9), 0
                    states.add(goal_id, there[goal_id][0])
            case "put" if there:
                goal_id = random.choice([*there])
                there[goal_id] = there[goal_id][0], random.randrange(7)
                states.put(goal_id, there[goal_id][1])
            case "remove" if there:
                goal_id = random.choice([*there])
                del there[goal_id]
                states.remove(goal_id)
        payload = states.to_bytes()
        message = CODEC.decode(payload)
        told = {bytes(e.goal_info.goal_id.uuid): (_ns(e.goal_info.stamp), e.status) for e in message.status_list}
        assert told == there
        assert CODEC.encode(message) == payload
        strange = random.randbytes(16)
        assert states_in(payload, [*there, strange]) == {goal_id: state for goal_id, (_, state) in there.items()}


def _ns(stamp: Time) -> int:
    return stamp.sec * 10**9 + stamp.nanosec


def test_an_id_across_two_entries_is_none() -> None:
    """A match of an id where no entry begins is skipped."""
    states = GoalStates()
    for i in range(1, 4):
        states.add(bytes([i]) * 16, 0)
    assert states_in(states.to_bytes(), [bytes([1]) * 15 + bytes(1), bytes(16)]) == {}


class Counted(bytes):
    """Counts how often something is looked for in it."""

    finds = 0

    def find(self, *given: Any) -> int:
        self.finds += 1
        return super().find(*given)


def test_decoys_cost_no_time() -> None:
    """A message made of ids in wrong places is looked through a few times, and not once for each."""
    sought, count = bytes([7]) * 16, 1000
    head = b"\0\1\0\0" + count.to_bytes(4, "little") + bytes(28 - 3)
    payload = Counted(head + (bytes(1) + bytes([7]) * 17 + bytes(10)) * (count - 1))
    assert states_in(payload, [sought]) == {}
    assert payload.finds < 20


def test_what_others_send() -> None:
    """Messages of ROS are read; what is cut off, or says another number of goals, is refused."""
    info = GoalInfo(goal_id=UUID(uuid=[7] * 16), stamp=Time(sec=5))
    payload = CODEC.encode(GoalStatusArray(status_list=[GoalStatus(goal_info=info, status=4)] * 2))
    assert states_in(payload, [bytes([7]) * 16]) == {bytes([7]) * 16: 4}
    assert states_in(payload + bytes(3), [bytes([7]) * 16]) == {bytes([7]) * 16: 4}
    assert states_in(CODEC.encode(GoalStatusArray()), [bytes(16)]) == {}
    for wrong in (b"", payload[:-1], payload[:20], b"\0\0" + payload[2:], payload[:4] + b"\xff" * 4 + payload[8:]):
        with pytest.raises(DecodeError, match="GoalStatusArray"):
            states_in(wrong, [bytes([7]) * 16])
