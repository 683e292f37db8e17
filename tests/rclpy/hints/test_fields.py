"""Next steps for errors about messages."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Path as Route
from rcl_interfaces.msg import ParameterValue
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool, Header, Int32

from rclpy.clock import Clock
from rclpy.parameter import Parameter
from tests.rclpy.hinted import hint_of

ONE = "dimensions, and the field one: write "


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("m.data = n / 2", "m.data is an int: write int(...) or //"),
        ("m.data = 0.5 * n", "m.data is an int: write int(...)"),
        ("m.data = words[1]  # the second", "write m.data = int(words[1])"),
        ("m.data = Int32(data=1)", "Int32(data=1) is a message: write m.data = Int32(data=1).data"),
        ("m.data = param", "a parameter's value is in .value: m.data = param.value"),
        (
            "t.linear.x = param.get_parameter_value()",
            "write t.linear.x = get_parameter('name').value in place of .get_parameter_value()",
        ),
        ("h.stamp = clock.now()", "write h.stamp = clock.now().to_msg()"),
        ("h.stamp = time.time()", "write h.stamp = self.get_clock().now().to_msg()"),
        ("h.stamp = n", "h.stamp is a Time: set its fields, as in h.stamp.sec = ..."),
        ("h.frame_id = n", "write h.frame_id = str(n)"),
        ("h.frame_id = None", ""),
        ("t.linear = 2.0", "t.linear is a Vector3: set its fields, as in t.linear.x = ..."),
        ("t.linear = Vector3", "that is a class, not a message: write t.linear = Vector3()"),
        ("t.linear = h", "t.linear is a Vector3, and was given a Header"),
        ("t.linear.x = 2", "t.linear.x is a float: write 2.0"),
        ("Vector3(x=2)", "write x=2.0, or x=float(...)"),
        ("t.linear.x = n", "write t.linear.x = float(n)"),
        ("t.linear.x = '2'", "write t.linear.x = float('2')"),
        ("t.linear.x = 'fast'", "t.linear.x is a float, and 'fast' is no number"),
        ("m.data = 'two'", "m.data is an int, and 'two' is no number"),
        ("t.linear.x = None", ""),
        (
            "t.linear.x = 5.0 * zeros(1)",
            "t.linear.x is a float, got an array of shape (1,): write float((5.0 * zeros(1))[0])",
        ),
        (
            "t.linear.x = matrix",
            "t.linear.x is a float, got an array of shape (1, 1): write float(matrix[0, 0])",
        ),
        (
            "t.linear.x = zeros(2)",
            "t.linear.x is a float, got an array of shape (2,): write one of its elements, float((zeros(2))",
        ),
        ("t.linear.x = float32(n)", "write t.linear.x = float(float32(n))"),
        ("m.data = int64(n)", "write m.data = int(int64(n))"),
        ("made.linear.x = 2.0", "made is the class Twist, not a message: write made = Twist()"),
        ("2.0 - made.linear", "made is the class Twist, not a message: write made = Twist()"),
        ("2.0 - Vector3.x", "Vector3 is a class, not a message: write Vector3(), or use a message object"),
        (
            "image.data = zeros((2, 3, 3), 'uint8')",
            f"the array has 3 {ONE}array.tobytes()",
        ),
        (
            "joints.position = zeros((2, 3))",
            f"the array has 2 {ONE}array.ravel().tolist()",
        ),
        ("m.data = 1 << 40", "it was given 1099511627776"),
        ("b.data = 'yes'", "it was given 'yes': write True or False"),
        ("j.name = ['a', 2]", "one of its elements is 2: write [str(v) for v in ...]"),
        ("route.poses = [t]", "one of its elements is a Twist"),
        ("j.position = [1.0, 'b']", "one of its elements is 'b'"),
        ("j.position = [1.0, '2']", "one of its elements is '2': write [float(v) for v in ...]"),
        ("j.name = 'ab'", "it was given 'ab'"),
        ("j.position = 3.0", "it was given 3.0: a list is expected, write [3.0]"),
        ("t.linear.theta = 1.0", "Vector3 has x, y, z"),
        ("'heard ' + b", "b is a Bool, a message: take its field, b.data"),
        ("2 * value", "value is a ParameterValue: write get_parameter('name').value in place of"),
        ("2 * param.get_parameter_value()", "a parameter's value is in .value: write that in place of"),
        ("2 * None", ""),
        (
            "Fibonacci.Feedback().order",
            "Fibonacci_Feedback has sequence; order is in Fibonacci.Goal: use that, or correct the order of the "
            "definition, goal --- result --- feedback",
        ),
        (
            "AddTwoInts.Request().sum",
            "AddTwoInts_Request has a, b; sum is in AddTwoInts.Response: use that, or correct the order of the "
            "definition, request --- response",
        ),
        ("Fibonacci.Feedback([1])", "fields are given by name, as in Fibonacci.Feedback(name=...)"),
        ("AddTwoInts.Request().some", "AddTwoInts_Request has a, b"),
        ("Int32(data=1.5)", "data is an int: write int(...)"),
        ("Twist(linear=1.5)", "linear is a Vector3: set its fields, as in linear.x = ..."),
    ],
)
def test_values_of_fields(tmp_path: Path, line: str, sentence: str) -> None:
    """The line is shown as it should be."""
    file = tmp_path / "wrong.py"
    file.write_text(line)
    known = {"m": Int32(), "h": Header(), "t": Twist(), "n": 3, "words": ["a", "7"], "clock": Clock()}
    known |= {"b": Bool(), "j": JointState(), "route": Route()}
    known |= {"Int32": Int32, "Twist": Twist, "Vector3": Vector3, "param": Parameter("n", value=1)}
    known |= {"time": time, "value": ParameterValue(), "image": Image(), "joints": JointState(), "zeros": np.zeros}
    known |= {"Fibonacci": Fibonacci, "AddTwoInts": AddTwoInts}
    known |= {"made": Twist, "matrix": np.zeros((1, 1)), "float32": np.float32, "int64": np.int64}
    found = hint_of(lambda: exec(compile(line, str(file), "exec"), known))
    assert found.startswith(sentence) if sentence else found == ""


def test_arguments_of_a_service_in_the_wrong_order() -> None:
    """The order is told, whether a field is read or set; but a wrong field of the right message has its fields."""

    def swapped(response: Any, request: Any) -> None:
        response.sum = 3

    def reads(response: Any, request: Any) -> None:
        assert request.a

    def right(request: Any, response: Any) -> None:
        assert request.sum

    request, response = AddTwoInts.Request(), AddTwoInts.Response()
    for wrong in (swapped, reads):
        way = f"a service's callback receives the request first: def {wrong.__name__}(request, response)"
        assert hint_of(partial(wrong, request, response)) == way
    assert hint_of(lambda: right(request, response)).startswith("AddTwoInts_Request has a, b; sum is in AddTwoInts.Res")
    assert hint_of(lambda: reads(response, AddTwoInts.Response())).startswith(
        "AddTwoInts_Response has sum; a is in Add"
    )
