"""A node's parameters: declared, set together or not at all, checked and observed."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import ParameterError
from graphflow.interface import Parameter
from graphflow.runtime.parameters.params import Parameters
from tests.runtime.cast import parameter


def parameters(*declared: Parameter, **overrides: Any) -> Parameters:
    made = Parameters({name: (value, "graph.yaml:3") for name, value in overrides.items()})
    for one in declared:
        made.declare(one)
    return made


RATE = parameter("rate", "float", 1.0, unit="Hz", gt=0.0, le=100.0, doc="How often.")
COUNT = parameter("count", "int", 3, ge=0, le=255)
TITLE = parameter("title", "str", "hello")
FIXED = parameter("fixed", "bool", True, read_only=True)


def test_a_default_holds_until_something_is_set() -> None:
    """`source` gives the origin."""
    made = parameters(RATE)
    assert (made.get("rate"), made.source("rate")) == (1.0, "default")

    made.set({"rate": 2.0})
    assert (made.get("rate"), made.source("rate")) == (2.0, "set")

    made.set({"rate": 3.0}, source="node")
    assert made.source("rate") == "node"


def test_read_only() -> None:
    """It takes a value from outside at the start, and none later."""
    made = parameters(FIXED, fixed=False)
    assert made.get("fixed") is False

    with pytest.raises(ParameterError, match="parameter 'fixed' is read-only"):
        made.set({"fixed": True})


def test_all_or_none() -> None:
    """If one value does not fit, the others stay unchanged, and observers are not called."""
    made = parameters(RATE, COUNT, FIXED)
    told: list[Any] = []
    made.observe(told.append)

    for wrong in ({"count": 256}, {"fixed": False}, {"nothing": 1}):
        with pytest.raises(ParameterError):
            made.set({"rate": 5.0, **wrong})
    assert (made.get("rate"), told) == (1.0, [])

    made.set({"rate": 5.0, "count": 4})
    assert told == [{"rate": (1.0, 5.0), "count": (3, 4)}]


def test_a_check_can_refuse() -> None:
    """Its error refuses all changes before any is made; it receives the prospective values."""
    made = parameters(RATE, COUNT)
    seen: list[dict[str, Any]] = []

    def check(changes: Any) -> None:
        seen.append(dict(changes))
        if changes.get("count") == 13:
            raise ParameterError("not 13")

    made.check(check)
    with pytest.raises(ParameterError, match="not 13"):
        made.set({"rate": 2, "count": 13})
    made.set({"rate": 2})

    assert (made.get("rate"), made.get("count")) == (2.0, 3)
    assert seen == [{"rate": 2.0, "count": 13}, {"rate": 2.0}]


def test_unknown_names() -> None:
    """The error names the nearest parameter."""
    made = parameters(RATE, TITLE)

    for use in (made.get, made.describe, lambda name: made.set({name: 1})):
        with pytest.raises(ParameterError, match="there is no parameter 'rat'; did you mean 'rate'"):
            use("rat")
    assert "rat" not in made
    assert "rate" in made
    assert made.names() == ["rate", "title"]
    assert made.describe("rate") is RATE


def test_declared_twice() -> None:
    """A name is one parameter."""
    with pytest.raises(ParameterError, match="parameter 'rate' is declared twice"):
        parameters(RATE, RATE)


def test_an_override_takes_the_place_of_the_default() -> None:
    """Widened and checked like any value, with where it was written."""
    made = parameters(RATE, rate=5)

    assert made.get("rate") == 5.0
    assert made.source("rate") == "graph.yaml:3"


def test_a_wrong_override_names_its_place() -> None:
    """The error has its file and line."""
    with pytest.raises(ParameterError) as caught:
        parameters(RATE, rate=0)
    assert str(caught.value) == (
        "parameter 'rate' = 0.0 is out of range: more than 0 and at most 100 Hz (from graph.yaml:3)"
    )


def test_unused_overrides() -> None:
    """A misspelt override is reported with its place and the nearest name."""
    made = parameters(RATE, TITLE, rat=5, title="x")

    assert made.unused_overrides() == ["there is no parameter 'rat' (from graph.yaml:3); did you mean 'rate'?"]


def test_an_override_of_a_plain_attribute() -> None:
    """Is answered with how it becomes a parameter."""
    owner = type("Lamp", (), {"speed": 2.0, "log": print})
    made = Parameters({"speed": (3.0, "command line"), "log": (1, "command line")})
    assert made.unused_overrides(owner) == [
        "there is no parameter 'speed' (from command line); write speed = Param(2.0)",
        "there is no parameter 'log' (from command line)",
    ]


def test_an_observer_of_other_arguments() -> None:
    """The error has its definition."""

    def changed(name: str, old: object, new: object) -> None:
        """Be called with the wrong arguments."""

    observer: Any = changed
    with pytest.raises(TypeError, match=r"observe calls it with one argument, a dict .* def changed\(self, changes\)"):
        parameters(RATE).observe(observer)
