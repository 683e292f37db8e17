"""Calls of a launch file's own code, which makes actions: functions, loops, and action classes."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import yaml

from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import Context, RecordedCall, text


def code_of(call: RecordedCall) -> Callable[[], list[object]] | None:
    """Return a function that runs the code of an action and returns the actions it makes; None without code."""
    get = call.get
    match call.kind:
        case "OpaqueFunction":
            return lambda: [get("function", 0)(Context(), *(get("args") or ()), **(get("kwargs") or {}))]
        case "ForEach":
            return lambda: [get("function")(**values) for values in _each(_known(call, "input_values"))]
        case "ForLoop":
            return lambda: [get("function")(i) for i in range(int(_known(call, "length")))]
    if type(call).execute is not RecordedCall.execute:  # an action class of the launch file
        return lambda: [call.execute(Context())]
    return None


def is_off(call: RecordedCall) -> bool:
    """Return whether an action has a condition that is known to be false."""
    condition = call.get("condition")
    return RECORDING.values is not None and isinstance(condition, RecordedCall) and not condition.evaluate()


def _known(call: RecordedCall, name: str) -> str:
    return RECORDING.known(text(call.get(name, 0)))


def _each(values_text: str) -> Iterator[dict[str, object]]:
    """Yield the arguments of each call of ForEach: YAML mappings, separated by semicolons."""
    for one in filter(None, map(str.strip, values_text.split(";"))):
        values = yaml.safe_load(one)
        if not isinstance(values, dict):
            raise TypeError(f"ForEach: expected mappings, such as {{name: a}};{{name: b}}, got {one!r}")
        yield values
