"""What editors see of messages under ROS's names."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from graphflow.msgs import registry
from graphflow.msgs.stubs import write
from graphflow.rclpy.messages import classes
from graphflow.rclpy.messages.stubs import stub, stubs
from tests.cases import slow

USED = """\
from example_interfaces.action import Fibonacci
from geometry_msgs.msg import PoseStamped, Twist
from rcl_interfaces.msg import ParameterType
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import Trigger

twist = Twist()
twist.linear.x = 1.0
scan = LaserScan(ranges=[1.0])
scan.ranges = [1.0, 2.0]
scan.ranges.append(3.0)
Imu().orientation_covariance = [0.0] * 9
kind: int = ParameterType.PARAMETER_BOOL
seconds: int = PoseStamped().header.stamp.sec


def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
    return Trigger.Response(success=True, message="done")


order: int = Fibonacci.Goal(order=3).order
"""
WRONG = """\
twist.linear.x = "a"
scan.rangs = [1.0]
Fibonacci.Goal(orders=3)
"""


@pytest.mark.parametrize("package", registry.packages())
def test_they_say_what_there_is(package: str) -> None:
    """Every class is there at run time, with its fields, constants and parts."""
    for kind in registry.KINDS:
        for node in ast.parse(stub(package, kind)).body:
            if not isinstance(node, ast.ClassDef) or node.name.endswith("_Event"):
                continue
            whole, _, part = node.name.partition("_")
            cls: Any = classes.interface_class(f"{package}/{kind}/{whole}")
            cls = cls if not part else cls.Impl.FeedbackMessage if part == "FeedbackMessage" else getattr(cls, part)
            names = [n.target.id for n in node.body if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)]
            names += [n.name for n in node.body if isinstance(n, ast.FunctionDef)]
            assert not [name for name in names if not hasattr(cls, name)], node.name


@slow
def test_a_type_checker_reads_them(tmp_path: Path) -> None:
    """What runs is taken; a field that is misspelt or of another type is found."""
    write(stubs(registry.packages(), tmp_path))
    (tmp_path / "used.py").write_text(USED)
    (tmp_path / "wrong.py").write_text(USED + WRONG)

    def checked(file: str) -> str:
        words = ["--strict", "--config-file=", f"--cache-dir={tmp_path / 'cache'}", file]
        command = [sys.executable, "-m", "mypy", *words]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False).stdout

    assert checked("used.py").startswith("Success")
    out = checked("wrong.py")
    lines = USED.count("\n")
    assert [f":{lines + i}: error" in out for i in (1, 2, 3)] == [True] * 3
    assert "Found 3 errors" in out
