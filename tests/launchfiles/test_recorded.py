"""Recorded launch actions and their form in JSON."""

from __future__ import annotations

import json

from graphflow.launchfiles.recorded import Action


def test_there_and_back() -> None:
    """An action is the same after it was JSON, with the actions within it and its relations to others."""
    log = Action("log", {"message": "over"}, 4, after_number=1, after_what="exited")
    node = Action("node", {"pkg": "p", "exec": "e"}, 3, number=1, brought_to="active")
    group = Action("group", {"scoped": True}, 2, children=[node, log])
    assert Action.from_json(json.loads(json.dumps(group.to_json()))) == group


def test_what_is_not_set_is_not_written() -> None:
    """An action without relations has only its attributes and its line."""
    assert Action("log", {"message": "a"}, 7).to_json() == {"log": {"message": "a", "line": 7}}
