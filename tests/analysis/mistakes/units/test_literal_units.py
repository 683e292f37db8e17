"""Numbers in milliseconds and degrees where seconds and radians are taken."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.units.literal_units import literal_units

POSE = """
from turtlesim.msg import Pose

class Robot:
    def moved(self, pose: Pose):
        return {}
"""


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (
            "@timer(500)\ndef f(): ...",
            "a period is in seconds: the first call comes after 500 s; if 500 ms are meant, write 0.5",
        ),
        (
            "async def f(self):\n    await self.clock.sleep(500)",
            "a sleep is in seconds, and this one takes 500 s; if 500 ms are meant, write 0.5",
        ),
        ("self.create_timer(100, self.f)", "the first call comes after 100 s; if 100 ms are meant, write 0.1"),
        ("self.create_timer(timer_period_sec=2000, callback=f)", "if 2000 ms are meant, write 2"),
        (
            "period = 500\nself.create_timer(period, self.f)",
            "period is 500, and a period is in seconds: the first call",
        ),
        ("Transform.of('a', 'b', rpy=(0.0, 0, -90))", "rpy is in radians: -90 degrees are -1.571, math.radians(-90)"),
        ("Spawn.Request(x=1.0, theta=180.0)", "theta is in radians: 180 degrees are 3.142"),
        (
            "from turtlesim.msg import Pose\n"
            "class A:\n"
            "    def __init__(self): self.create_subscription(Pose, 'pose', self.moved, 1)\n"
            "    def moved(self, pose): return pose.theta > 90",
            "pose.theta is in radians, from -3.142 to 3.142: 90 degrees are 1.571",
        ),
        ("msg.angular.z = 90.0", "in radians per second: 90 degrees are 1.571, math.radians(90)"),
        ("self.twist.angular.z = -45", "in radians per second: -45 degrees are -0.7854, math.radians(-45)"),
        ("Twist(angular=Vector3(z=180.0))", "in radians per second: 180 degrees are 3.142"),
        ("quaternion_from_euler(0, 0, 45)", "an angle is in radians: 45 degrees are 0.7854"),
        (POSE.format("pose.theta < -90"), "from -3.142 to 3.142: -90 degrees are -1.571, math.radians(-90)"),
        (POSE.format("90 < pose.theta"), "from -3.142 to 3.142: 90 degrees are 1.571, math.radians(90)"),
    ],
)
def test_numbers_in_another_unit(code: str, told: str) -> None:
    """The sentence has both values."""
    [(_, text)] = literal_units(ast.parse(code))
    assert told in text


DRIVES = "{}\n    def drive(self):\n        msg = Twist()\n        self.pub.publish(msg)\n"
FILLS = "{}\n    def drive(self):\n        self.msg.linear.x = 1.0\n"
COUNTS = "{}\n    def drive(self):\n        self.pub.publish(Int32())\n"
LOGS = "{}\n    def drive(self):\n        self.get_logger().info('on')\n"
DECORATED = "class A(Node):\n    @timer({})"
CREATED = "class A(Node):\n    def __init__(self):\n        self.create_timer({}, self.drive)"


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (
            DRIVES.format(DECORATED.format(10)),
            "a command comes every 10 s; if 10 per second are meant, write @timer(hz=10), else 10.0",
        ),
        (
            COUNTS.format(DECORATED.format(10)),
            "a message comes every 10 s; if 10 per second are meant, write @timer(hz=10), else 10.0",
        ),
        (
            FILLS.format(CREATED.format(20)),
            "every 20 s; if 20 per second are meant, write create_timer(1 / 20, ...), else 20.0",
        ),
        ("rate = 10\n" + FILLS.format(CREATED.format("rate")), "rate is 10, and a period is in seconds: a command"),
        (DRIVES.format(DECORATED.format(5)), ""),
        (DRIVES.format(DECORATED.format("10.0")), ""),
        (DRIVES.format(DECORATED.format("hz=10")), ""),
        (COUNTS.format(DECORATED.format(30)), ""),
        (COUNTS.format(DECORATED.format("10.0")), ""),
        (LOGS.format(DECORATED.format(10)), ""),
        (DRIVES.format(CREATED.format(10)).replace("self.drive)", "lambda: None)"), ""),
    ],
)
def test_rates_as_periods(code: str, told: str) -> None:
    """A robot is told what to do many times a second, and not every ten seconds; other things may be that slow."""
    texts = [text for _, text in literal_units(ast.parse(code))]
    assert [told in text for text in texts] == ([True] if told else [])


@pytest.mark.parametrize("period", ["60", "300", "3600", "600.0", "0.5", "30.0", "True", "rate"])
def test_periods_that_may_be_meant(period: str) -> None:
    """Whole minutes, fractions, small numbers and computed ones are left alone."""
    assert literal_units(ast.parse(f"timer({period})")) == ()


@pytest.mark.parametrize(
    "code",
    [
        *("msg.angular.z = 1.5", "msg.angular.z = 0", "msg.angular.z = 20.0", "msg.linear.z = 90.0", "x.z = 90"),
        *("period = 0.5\ntimer(period)", "period = 500\nperiod = 0.5\ntimer(period)"),
        *("def f(x): timer(x)", "self.create_rate(100)"),
    ],
)
def test_names_and_rates(code: str) -> None:
    """A name that is bound to another number, and an argument, are left alone; a rate is a frequency."""
    assert literal_units(ast.parse(code)) == ()


@pytest.mark.parametrize(
    "code",
    [
        *("Pose(theta=9.42)", "Pose(theta=5)", "Pose(theta=15.5)", "draw(angle=math.radians(90))", "move(x=90)"),
        "quaternion_from_euler(0, 0, yaw)",
    ],
)
def test_angles_that_may_be_meant(code: str) -> None:
    """Small numbers, fractions, computed ones, and what is no angle are left alone."""
    assert literal_units(ast.parse(code)) == ()


@pytest.mark.parametrize(
    "code",
    [
        *("pose.theta > 90", "def f(self, robot): return robot.theta > 90"),
        *(POSE.format(f"pose.{test}") for test in ("theta > 3", "theta < -1.5", "theta > self.limit", "x > 10")),
    ],
)
def test_angles_that_a_pose_may_have(code: str) -> None:
    """Another class may keep degrees, and a pose's angles are small."""
    assert literal_units(ast.parse(code)) == ()
