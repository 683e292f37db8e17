"""Which domain a process belongs to."""

from __future__ import annotations

import pytest

from graphflow.domain import domain_id, domain_variable
from graphflow.errors import GraphflowError


@pytest.mark.parametrize(
    ("given", "ours", "ros", "domain"),
    [
        (None, None, None, 0),
        (None, None, "7", 7),
        (None, "3", "7", 3),
        (None, " 3 ", None, 3),
        (None, "", "7", 7),
        (None, "0", "7", 0),
        (5, "3", "7", 5),
        (0, "3", "7", 0),
        (5, "x", "x", 5),
    ],
)
def test_what_is_said_first_counts(
    monkeypatch: pytest.MonkeyPatch, given: int | None, ours: str | None, ros: str | None, domain: int
) -> None:
    """What is given, then GRAPHFLOW_DOMAIN, then ROS_DOMAIN_ID, then 0; an empty variable says nothing."""
    for variable, value in (("GRAPHFLOW_DOMAIN", ours), ("ROS_DOMAIN_ID", ros)):
        if value is None:
            monkeypatch.delenv(variable, raising=False)
        else:
            monkeypatch.setenv(variable, value)

    assert domain_id(given) == domain


@pytest.mark.parametrize("variable", ["GRAPHFLOW_DOMAIN", "ROS_DOMAIN_ID"])
@pytest.mark.parametrize("value", ["x", "-1", "1.5", "0x10", "1_0"])
def test_a_variable_that_is_no_number(monkeypatch: pytest.MonkeyPatch, variable: str, value: str) -> None:
    """The error has the variable's name and value, and what it should be."""
    monkeypatch.delenv("GRAPHFLOW_DOMAIN", raising=False)
    monkeypatch.setenv(variable, value)

    with pytest.raises(GraphflowError) as caught:
        domain_id()
    assert str(caught.value) == f"{variable}={value!r}: a domain is a whole number, 0 or more"


def test_the_variable_that_decides(monkeypatch: pytest.MonkeyPatch) -> None:
    """Is the first that is set, and ours where none is."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "")
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    assert domain_variable() == "GRAPHFLOW_DOMAIN"
    monkeypatch.setenv("ROS_DOMAIN_ID", "5")
    assert domain_variable() == "ROS_DOMAIN_ID"
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "7")
    assert domain_variable() == "GRAPHFLOW_DOMAIN"
