"""The command line as data."""

from __future__ import annotations

import json

from graphflow.cli.tree import verbs


def test_verbs_arguments_and_options() -> None:
    """As the console completes them."""
    tree = verbs()
    assert {"up", "topic", "param", "restart"} <= set(tree)
    echo = tree["topic"]["commands"]["echo"]
    assert echo["arguments"] == ["TOPIC", "[TYPE]"]
    assert echo["options"]["--once"] is False
    assert echo["options"]["--field"] is True
    assert tree["groups"]["commands"]["move"]["arguments"] == ["NODE", "HANDLER...", "GROUP"]
    assert json.loads(json.dumps(tree)) == tree
