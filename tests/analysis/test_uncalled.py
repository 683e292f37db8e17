"""Programs whose `main()` nothing calls."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.uncalled import uncalled, uncalled_methods

MAIN = "def main():\n    rclpy.init()\n"
NEVER = "talk.py:1: main() is defined and never called; add as the last line: if __name__ == '__main__': main()"


@pytest.mark.parametrize(
    ("source", "told"),
    [
        (MAIN, NEVER),
        (f"{MAIN}if __name__ == '__main__':\n    main()\n", ""),
        (f"{MAIN}Thread(target=main).start()\n", ""),
        (
            f"{MAIN}if __name__ == '__main__':\n    main\n",
            "talk.py:4: main without parentheses calls nothing; write: main()",
        ),
        (
            f"{MAIN}if __name__ == 'main':\n    main()\n",
            "talk.py:3: __name__ is never 'main', so nothing runs; write: if __name__ == '__main__':",
        ),
        (
            "async def main():\n    pass\n",
            "talk.py:1: main() is defined and never called; add as the last line: "
            "if __name__ == '__main__': asyncio.run(main())",
        ),
        (
            "def begin():\n    graphflow.run(Talk)\n",
            "talk.py:1: begin() is defined and never called; add as the last line: if __name__ == '__main__': begin()",
        ),
        (
            "def begin():\n    graphflow.run(Talk)\ndef main():\n    begin\n",
            "talk.py:3: main() is defined and never called; add as the last line: if __name__ == '__main__': main()",
        ),
        (
            "def generate_launch_description():\n    return LaunchDescription([])\n",
            "talk.py:1: generate_launch_description() makes it a launch file; write: graphflow launch talk.py",
        ),
        ("def generate_launch_description(): ...\nls.include_launch_description(generate_launch_description())", ""),
        ("def helper():\n    return 1\n", ""),
        (f"@app.command()\n{MAIN}app()\n", ""),
        ("from talk import main\n", ""),
        ("def main(:\n", ""),
        ("if __name__ == '__mp_main__':\n    prepare()\n", ""),
        (f"{MAIN}globals()['main']()\n", ""),
    ],
)
def test_a_main_that_nothing_calls(source: str, told: str) -> None:
    """Is told with its line and the line that calls it."""
    assert uncalled(source, "talk.py") == told


ALWAYS = "{0} without parentheses is always true; write: {0}()"


@pytest.mark.parametrize(
    ("line", "shown"),
    [
        ("while not self.adder.service_is_ready: pass", "self.adder.service_is_ready"),
        ("assert self.adder.server_is_ready, 'no'", "self.adder.server_is_ready"),
        ("if a and not (b or self.adder.wait_for_service): pass", "self.adder.wait_for_service"),
        ("x = 1 if rclpy.ok else 2", "rclpy.ok"),
        ("while not self.future.done: pass", "self.future.done"),
        ("if not self.out.get_subscription_count: pass", "self.out.get_subscription_count"),
        ("while not self.adder.service_is_ready(): pass", ""),
        ("if goal.done: pass", ""),
        ("if self.is_canceled: self.is_canceled = False", ""),
        ("if self.lamp.ok: pass", ""),
        ("if asks(self.adder.service_is_ready): pass", ""),
    ],
)
def test_questions_that_are_not_asked(line: str, shown: str) -> None:
    """Are told where they decide something; attributes of the user's by such names are not."""
    told = [text for _, text in uncalled_methods(ast.parse(f"def tick(self):\n    {line}\n"))]
    assert told == ([ALWAYS.format(shown)] if shown else [])


def test_methods_without_parentheses() -> None:
    """Known ones that are a statement of their own, and no others."""
    source = "def tick(self):\n    self.timer.cancel\n    self.rate\n    x = self.close\n    self.close()\n"
    assert list(uncalled_methods(ast.parse(source))) == [
        (2, "self.timer.cancel without parentheses calls nothing; write: self.timer.cancel()")
    ]


@pytest.mark.parametrize(
    ("line", "call"), [("rclpy.init", "rclpy.init()"), ("rclpy.spin", "rclpy.spin(node)"), ("self.init", "")]
)
def test_functions_of_rclpy_without_parentheses(line: str, call: str) -> None:
    """They come with the argument that they need."""
    told = f"{line} without parentheses calls nothing; write: {call}"
    assert [text for _, text in uncalled_methods(ast.parse(f"def main():\n    {line}\n"))] == ([told] if call else [])


@pytest.mark.parametrize("is_called", [True, False])
def test_a_count_that_is_not_asked(is_called: bool) -> None:
    """Is told where it is compared."""
    count = f"self.out.get_subscription_count{'()' if is_called else ''}"
    told = f"{count} without parentheses is a method, and no number; write: {count}()"
    source = f"def tick(self):\n    x = 1 if {count} == 0 else 2\n"
    assert list(uncalled_methods(ast.parse(source))) == ([] if is_called else [(2, told)])


EVENTS = """
class Robot(Node):
    @subscription(Pose, "pose")
    async def on_pose(self, pose):
        {}

    @timer(1.0)
    async def drive(self): ...

    def turn(self, angle): ...

    @property
    def reset(self): ...

    @cached_property
    def map(self): ...
"""


@pytest.mark.parametrize(
    ("line", "call"),
    [
        ("self.near_wall.set", "self.near_wall.set()"),
        ("event.clear", "event.clear()"),
        ("self.timer.reset", "self.timer.reset()"),
        ("self.lock.release", "self.lock.release()"),
        ("executor.spin", "executor.spin()"),
        ("self.turn", "self.turn(angle)"),
        ("if pose.x > 9: self.drive", "await self.drive()"),
        ("with self.lock: self.near_wall.set", "self.near_wall.set()"),
        ("try:\n            event.set\n        except OSError: pass", "event.set()"),
    ],
)
def test_events_locks_and_own_methods(line: str, call: str) -> None:
    """Are told with their call."""
    [(_, text)] = uncalled_methods(ast.parse(EVENTS.format(line)))
    assert text.partition("; write: ")[2] == call


@pytest.mark.parametrize(
    "line",
    [
        "self.reset",
        "self.map",
        "self.near_wall.set()",
        "self.callback = self.turn",
        "self.start = 1; self.start",
        "with pytest.raises(AttributeError): self.lock.release",
        "try:\n            event.set\n        except AttributeError: pass",
    ],
)
def test_lines_that_do_something(line: str) -> None:
    """Properties, methods that are passed on, attributes of the program, and lines that are there for their error."""
    assert list(uncalled_methods(ast.parse(EVENTS.format(line)))) == []


def test_a_value_of_a_slice() -> None:
    """It is looked at outside functions, as in a notebook's cell."""
    assert list(uncalled_methods(ast.parse("part.start\npart.stop\n"))) == []
