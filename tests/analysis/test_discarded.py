"""Nodes that a program makes and neither runs nor keeps."""

from __future__ import annotations

import pytest

from graphflow.analysis.discarded import discarded

RUN = "talk.py:{}: {} makes a node and does not run it; write: graphflow.run(Talk)"


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("Talk()\n", RUN.format(1, "Talk()")),
        ("if __name__ == '__main__':\n    Talk(rate=2.0)\n", RUN.format(2, "Talk(rate=2.0)")),
        ("def main():\n    node = Talk()\nmain()\n", RUN.format(2, "node = Talk()").replace("node = ", "")),
        ("def main():\n    Talk()\nmain()\n", RUN.format(2, "Talk()")),
        (
            "def main():\n    graphflow.run(Talk)\nTalk()\n",
            "talk.py:3: Talk() makes a node and does not run it; write: main()",
        ),
        ("node = Talk()\nprint(node.rate)\n", ""),
        ("Talk()\nprint('it can be made')\n", ""),
        ("print(Talk())\n", ""),
        ("node = Talk()\nprint('it can be made')\n", ""),
        ("Other()\n", ""),
        ("assert Talk().add(1, 2) == 3\n", ""),
        ("class Test(TestCase):\n    def test_it(self):\n        node = Talk()\n", ""),
        ("Talk(\n", ""),
    ],
)
def test_nodes_that_nothing_uses(source: str, told: str) -> None:
    """Are told with their line; one that is looked at, or made to see that it can be, is not."""
    assert discarded(source, "talk.py", ["Talk"]) == told
