"""Schemas, and the types derived from services and actions."""

from __future__ import annotations

import pytest

from graphflow.wire import idl
from graphflow.wire.schema import (
    INTEGER_RANGES,
    NUMERIC,
    PRIMITIVES,
    Action,
    FieldType,
    Message,
    Service,
    string_length,
)

SERVICE = Service("p/srv/S", Message("p/srv/S_Request"), Message("p/srv/S_Response"))
ACTION = Action("p/action/A", Message("p/action/A_Goal"), Message("p/action/A_Result"), Message("p/action/A_Feedback"))


def fields(message: Message) -> list[tuple[str, str]]:
    return [(f.name, str(f.type)) for f in message.fields]


@pytest.mark.parametrize(
    "text",
    ["bool", "string<=5", "float64[3]", "uint8[]", "string<=5[<=10]", "wstring<=2[4]", "p/msg/T[<=2]", "p/msg/T"],
)
def test_a_type_prints_as_it_is_written(text: str) -> None:
    """A field type's text is what a definition would say."""
    assert str(idl.parse_type(text, "p")) == text


def test_integer_ranges_are_those_of_their_bits() -> None:
    """Every integer type holds what its bits can."""
    for name, (low, high) in INTEGER_RANGES.items():
        bits = int(name.removeprefix("u").removeprefix("int")) if "int" in name else 8
        signed = name.startswith("int")
        assert (low, high) == ((-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if signed else (0, 2**bits - 1))


def test_primitives_are_numbers_and_strings() -> None:
    """The fifteen primitive types of .msg files, and no others, are primitive."""
    assert len(PRIMITIVES) == 15
    assert {"string", "wstring"} == PRIMITIVES - NUMERIC
    assert FieldType("char").is_primitive
    assert not FieldType("p/msg/T").is_primitive


@pytest.mark.parametrize(
    ("base", "text", "length"),
    [("string", "hé€", 6), ("wstring", "hé€", 3), ("wstring", "\N{TURTLE}", 2), ("string", "", 0)],
)
def test_string_length_is_in_the_units_of_the_wire(base: str, text: str, length: int) -> None:
    """A string's bound counts bytes of UTF-8, a wstring's counts units of UTF-16."""
    assert string_length(base, text) == length


def test_a_service_has_four_messages() -> None:
    """A service's event and whole are made as upstream makes them."""
    assert [m.name for m in SERVICE.messages] == ["p/srv/S_Request", "p/srv/S_Response", "p/srv/S_Event", "p/srv/S"]
    assert fields(SERVICE.event) == [
        ("info", "service_msgs/msg/ServiceEventInfo"),
        ("request", "p/srv/S_Request[<=1]"),
        ("response", "p/srv/S_Response[<=1]"),
    ]
    assert fields(SERVICE.whole) == [
        ("request_message", "p/srv/S_Request"),
        ("response_message", "p/srv/S_Response"),
        ("event_message", "p/srv/S_Event"),
    ]


def test_an_actions_services_carry_goal_and_result() -> None:
    """The two services of an action add the goal's id, acceptance, time and status to what the user defined."""
    send, get = ACTION.services
    assert (send.name, get.name) == ("p/action/A_SendGoal", "p/action/A_GetResult")
    assert fields(send.request) == [("goal_id", "unique_identifier_msgs/msg/UUID"), ("goal", "p/action/A_Goal")]
    assert fields(send.response) == [("accepted", "bool"), ("stamp", "builtin_interfaces/msg/Time")]
    assert fields(get.request) == [("goal_id", "unique_identifier_msgs/msg/UUID")]
    assert fields(get.response) == [("status", "int8"), ("result", "p/action/A_Result")]


def test_an_actions_feedback_carries_the_goals_id() -> None:
    """Feedback is sent with the id of the goal it belongs to."""
    assert ACTION.feedback_message.name == "p/action/A_FeedbackMessage"
    assert fields(ACTION.feedback_message) == [
        ("goal_id", "unique_identifier_msgs/msg/UUID"),
        ("feedback", "p/action/A_Feedback"),
    ]


def test_an_action_as_a_whole_names_all_its_parts() -> None:
    """The whole of an action has its six parts in upstream's order."""
    assert fields(ACTION.whole) == [
        ("goal", "p/action/A_Goal"),
        ("result", "p/action/A_Result"),
        ("feedback", "p/action/A_Feedback"),
        ("send_goal_service", "p/action/A_SendGoal"),
        ("get_result_service", "p/action/A_GetResult"),
        ("feedback_message", "p/action/A_FeedbackMessage"),
    ]


def test_an_action_has_thirteen_messages() -> None:
    """Goal, result, feedback, feedback message and whole, and four of each service, each under its own name."""
    names = [m.name for m in ACTION.messages]
    assert len(names) == len(set(names)) == 13
