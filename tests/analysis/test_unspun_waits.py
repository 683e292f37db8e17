"""Waits of a program's own functions that nothing spins meanwhile."""

from __future__ import annotations

import ast
from textwrap import indent

import pytest

from graphflow.analysis.unspun_waits import unspun_waits

CLIENT = "adder = node.create_client(AddTwoInts, 'add')\n"
NEVER = "and nothing spins meanwhile: "


def found(body: str, before: str = "") -> list[str]:
    module = ast.parse(f"{before}\ndef main():\n{indent(body, '    ')}")
    return [f"{finding.grade} {finding.place.line} {finding.text}" for finding in unspun_waits(module, "p.py")]


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (
            f"{CLIENT}answer = adder.call(request)",
            f"CERTAIN 4 main: adder.call waits for the answer, {NEVER}future = adder.call_async(request), then "
            "rclpy.spin_until_future_complete(node, future)",
        ),
        (
            f"{CLIENT}if ready:\n    adder.call(request)",
            f"IF THIS BRANCH RUNS 5 main: adder.call waits for the answer, {NEVER}future = adder.call_async(request), "
            "then rclpy.spin_until_future_complete(node, future)",
        ),
        (
            "future = node.adder.call_async(request)\nwhile not future.done():\n    time.sleep(0.1)",
            "CERTAIN 4 main: the loop waits for future, and nothing spins meanwhile: write "
            "rclpy.spin_until_future_complete(node, future)",
        ),
        (
            "rate = node.create_rate(2)\nwhile rclpy.ok():\n    rate.sleep()",
            f"CERTAIN 5 main: rate.sleep waits for a timer, {NEVER}make a timer in its place, or spin in a thread "
            "before: Thread(target=rclpy.spin, args=(node,), daemon=True).start()",
        ),
    ],
)
def test_waits_that_never_end(body: str, told: str) -> None:
    """They are told with their function and the remedy; not where a thread may spin."""
    assert found(body) == [told]
    assert found(body, "Thread(target=rclpy.spin, args=(node,)).start()") == []


WAITS = (
    f"{CLIENT}future = adder.call_async(request)\nwhile not future.done():\n    time.sleep(0.1)\nadder.call(request)"
)


@pytest.mark.parametrize(
    "before",
    [
        "import asyncio",
        "class Spinner(threading.Thread):\n    pass",
        "pool = ProcessPoolExecutor()",
        "from concurrent.futures import ThreadPoolExecutor",
    ],
)
def test_programs_in_which_something_else_may_spin(before: str) -> None:
    """Nothing is certain of them."""
    assert len(found(WAITS)) == 2
    assert found(WAITS, before) == []
    assert [*unspun_waits(ast.parse(f"async def main():\n{indent(WAITS, '    ')}"), "p.py")] == []


@pytest.mark.parametrize(
    "body",
    [
        "future = node.adder.call_async(request)\nwhile not future.done():\n    rclpy.spin_once(node)",
        "future = node.adder.call_async(request)\nwhile not future.done():\n    step(node)",
        "future = pool.submit(work)\nwhile not future.done():\n    time.sleep(0.1)",
        "node.adder.call(request)",
        "subprocess.call(['ls'])",
        "rate.sleep()",
        "while not done():\n    time.sleep(0.1)",
    ],
)
def test_other_calls(body: str) -> None:
    """Calls that spin, and those of other things than clients and rates, are left alone."""
    assert found(body) == []
