"""The code of a launch file that actions call to make others: functions, loops, and actions of the file's own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import yaml

from graphflow.launchfiles.python.stand_ins import RECORDING, Context, Said, text


def code_of(said: Said) -> Callable[[], list[Any]] | None:
    """A function that calls the code of an action and returns the actions made by it; None for actions without code."""
    get = said.get
    match said.kind:
        case "OpaqueFunction":
            return lambda: [get("function", 0)(Context(), *(get("args") or ()), **(get("kwargs") or {}))]
        case "ForEach":
            return lambda: [get("function")(**values) for values in _each(_known(said, "input_values"))]
        case "ForLoop":
            return lambda: [get("function")(i) for i in range(int(_known(said, "length")))]
    if type(said).execute is not Said.execute:
        return lambda: [said.execute(Context())]
    return None


def is_off(said: Said) -> bool:
    """Whether an action has a condition that is known to be false."""
    condition = said.get("condition")
    return RECORDING.values is not None and isinstance(condition, Said) and not condition.evaluate()


def _known(said: Said, name: str) -> str:
    return RECORDING.known(text(said.get(name, 0)))


def _each(written: str) -> Iterator[dict[str, Any]]:
    """The arguments of each call: mappings in YAML, with semicolons between them."""
    for one in filter(None, map(str.strip, written.split(";"))):
        values = yaml.safe_load(one)
        if not isinstance(values, dict):
            raise TypeError(f"ForEach: expected mappings, such as {{name: a}};{{name: b}}, got {one!r}")
        yield values
