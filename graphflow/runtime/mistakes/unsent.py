"""Goals that a line has made, and not sent: `goal = self.client.send(...)`, outside of `async with`."""

from __future__ import annotations

import ast
import linecache
from contextlib import suppress

from graphflow.analysis.user_code import short_place
from graphflow.errors import Place


def sending_line(place: Place) -> str:
    """Return the line that sends the goal, in the program's own words if it is an assignment on one line."""
    line = linecache.getline(place.file, place.line).strip()
    with suppress(SyntaxError):
        match ast.parse(line).body:
            case [ast.Assign(targets=[name], value=ast.Call(func=ast.Attribute(attr="send") as send) as call)]:
                send.attr = "send_goal"
                where = short_place(place.file, place.line)
                return f"write {ast.unparse(name)} = await {ast.unparse(call)}, in {where}"
    return "write `async with client.send(goal) as sent:`"
