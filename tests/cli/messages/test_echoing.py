"""The output of `topic echo`."""

from __future__ import annotations

import json
from typing import Any

from graphflow.cli.messages.echo_options import EchoOptions
from graphflow.cli.messages.echoing import render
from graphflow.msgs import registry
from graphflow.msgs.geometry_msgs.msg import Point, Polygon, Twist, Vector3
from graphflow.msgs.rcl_interfaces.msg import ParameterValue
from graphflow.msgs.std_msgs.msg import String
from graphflow.wire.attachment import MessageInfo

TWIST = Twist(linear=Vector3(x=2.0), angular=Vector3(z=1.8))
INFO = MessageInfo(sequence=7, source_ns=1_500_000_000, gid=bytes(range(16)))


def shown(message: Any, path: list[str | int] | None = None, **options: Any) -> str:
    return render(message, INFO, EchoOptions(**options), path or [])


def test_block_style() -> None:
    """A message is printed as in ROS 2: one field per line, then three dashes."""
    assert shown(TWIST) == "linear:\n  x: 2.0\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 1.8\n---"


def test_flow_style() -> None:
    """Each top-level field has one line."""
    assert shown(TWIST, flow_style=True) == "linear: {x: 2.0, y: 0.0, z: 0.0}\nangular: {x: 0.0, y: 0.0, z: 1.8}\n---"
    assert shown(TWIST, ["linear", "x"], flow_style=True) == "2.0\n---"


def test_csv_has_no_dashes() -> None:
    """A message is a line of values."""
    assert shown(TWIST, csv=True) == "2.0,0.0,0.0,0.0,0.0,1.8"
    assert shown(TWIST, ["angular"], csv=True) == "0.0,0.0,1.8"


def test_json_is_whole() -> None:
    """Programs get everything, uncut, on one line."""
    message = ParameterValue(double_array_value=[0.5] * 500, string_value="x" * 500)
    found = shown(message, as_json=True, no_arr=True, no_str=True, truncate_length=1)
    assert "\n" not in found
    assert json.loads(found)["double_array_value"] == [0.5] * 500
    assert json.loads(found)["string_value"] == "x" * 500


def test_long_arrays_and_strings_are_cut() -> None:
    """Arrays and strings are cut at 128 elements, at a given length, or not at all."""
    message = ParameterValue(integer_array_value=list(range(200)), string_value="x" * 200)
    assert "\n- 127\n- ...\ndouble_array_value: []\n" in shown(message)
    assert f"string_value: {'x' * 128}..." in shown(message)
    cut = shown(message, ["integer_array_value"], truncate_length=2)
    assert cut == "- 0\n- 1\n- ...\n---"
    assert "- 199" in shown(message, full_length=True)
    assert "..." not in shown(message, full_length=True)


def test_without_arrays_and_strings() -> None:
    """Arrays and strings are replaced by their sizes."""
    message = ParameterValue(string_array_value=["a", "b"], string_value="hello")
    found = shown(message, no_arr=True, no_str=True).splitlines()
    assert "string_array_value: '<array of 2>'" in found
    assert "byte_array_value: '<array of 0>'" in found
    assert "string_value: '<string of 5>'" in found


def test_with_message_info() -> None:
    """Sequence number, time and sender come first, as a comment."""
    head, rest = shown(String(data="hi"), include_message_info=True).split("\n", 1)
    assert head == "# sequence 7, sent 1.500000000, by 00.01.02.03.04.05.06.07.08.09.0a.0b.0c.0d.0e.0f"
    assert rest == "data: hi\n---"


def test_a_part_of_a_message() -> None:
    """`--field` selects in fields, lists and arrays; a missing element is reported."""
    polygon = Polygon(points=[{"x": 1.0}, {"x": 2.0}])
    assert shown(polygon, ["points", 1, "x"]) == "2.0\n---"
    assert shown(polygon, ["points", 0]) == "x: 1.0\ny: 0.0\nz: 0.0\n---"
    lacking = render(polygon, INFO, EchoOptions(field="points[2].x"), ["points", 2, "x"])
    assert lacking == "# this message has no element points[2].x\n---"
    values = ParameterValue(double_array_value=[0.5, 1.5])
    assert shown(values, ["double_array_value", 1]) == "1.5\n---"
    assert shown(values, ["double_array_value"]) == "- 0.5\n- 1.5\n---"
    assert shown(Point(), ["x"], csv=True) == "0.0"


def test_calls_of_a_service() -> None:
    """The kind of event is printed by name."""
    event: Any = registry.interface_class("std_srvs/srv/Empty_Event")()
    event.info.event_type = 2
    assert render(event, INFO, EchoOptions(), []).startswith("info:\n  event_type: RESPONSE_SENT\n  stamp:\n")
    event.info.event_type = 9
    assert "event_type: 9\n" in render(event, INFO, EchoOptions(), [])
