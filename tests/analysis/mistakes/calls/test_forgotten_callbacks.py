"""Methods that nothing refers to."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.calls.forgotten_callbacks import forgotten_callbacks

PROGRAM = """\
class Robot(Node):
    def __init__(self):
        super().__init__('robot')
        self.pub = self.create_publisher(Twist, 'cmd_vel', 10)
    def {}:
        {}
def main():
    rclpy.spin(Robot())
"""


@pytest.mark.parametrize(
    ("method", "body", "way"),
    [
        ("timer_callback(self)", "print('tick')", "self.create_timer(0.5, self.timer_callback)"),
        ("drive(self)", "self.pub.publish(Twist())", "self.create_timer(0.5, self.drive)"),
        ("on_pose(self, pose)", "self.pose = pose", "self.create_subscription(Type, 'topic', self.on_pose, 10)"),
        ("hear(self, msg)", "print(msg)", "self.create_subscription(Type, 'topic', self.hear, 10)"),
        ("add(self, request, response)", "return response", "self.create_service(Type, 'name', self.add)"),
        ("execute(self, goal_handle)", "goal_handle.succeed()", "ActionServer(self, Type, 'name', self.execute)"),
        ("done(self, future)", "print(future.result())", "future.add_done_callback(self.done)"),
        ("show(self, feedback)", "...", "feedback_callback=self.show in send_goal_async(...)"),
        ("feedback_callback(self, msg)", "...", "feedback_callback=self.feedback_callback in send_goal_async(...)"),
    ],
)
def test_a_method_that_nothing_refers_to(method: str, body: str, way: str) -> None:
    """It is told with the line that would have it called."""
    name = method.partition("(")[0]
    told = [(5, f"nothing refers to {name}: write {way}")]
    assert list(forgotten_callbacks(ast.parse(PROGRAM.format(method, body)))) == told


@pytest.mark.parametrize(
    "program",
    [
        PROGRAM.format("on_pose(self, pose)", "...") + "    self.on_pose(None)",
        PROGRAM.format("on_pose(self, pose)", "...") + "    use(node, 'on_pose')",
        PROGRAM.format("on_pose(self, pose)", "getattr(self, f'on_{pose}')"),
        PROGRAM.format("on_pose(self, pose)", "...").replace("(Node)", "(LifecycleNode)"),
        PROGRAM.format("on_pose(self, pose)", "...").replace("main", "helper"),
        PROGRAM.format("on_pose(self, pose)", "...").replace("    def on", "    @handler\n    def on"),
        PROGRAM.format("destroy_node(self)", "self.pub.publish(Twist())"),
        PROGRAM.format("distance(self, pose)", "return pose.x"),
        PROGRAM.format("distance(self)", "return self.pose.x"),
        PROGRAM.format("clamp(self, value, limit)", "return min(value, limit)"),
        PROGRAM.format("tell(self)", "other.pub.publish(Twist())"),
    ],
)
def test_methods_that_may_be_called(program: str) -> None:
    """They are left alone, and so are helpers."""
    assert list(forgotten_callbacks(ast.parse(program))) == []
