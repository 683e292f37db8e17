"""Nodes in other domains."""

from __future__ import annotations

import pytest

from graphflow.machines.domains import by_domain, elsewhere, with_counterpart
from graphflow.wire.liveliness import Entity, Kind


def tokens(*nodes: str) -> list[str]:
    """Tokens of nodes, each written as `domain/name`."""
    split = [node.split("/") for node in nodes]
    return [Entity(int(d), "z", i, i, Kind.NODE, "/", name).token for i, (d, name) in enumerate(split)]


def test_nodes_are_counted() -> None:
    """By domain, without hidden ones, those that are left out, and what is no token."""
    found = by_domain([*tokens("0/a", "0/b", "5/a", "5/_hidden"), "malformed"], own=["/b"])
    assert found == {0: 1, 5: 1}


@pytest.mark.parametrize(
    ("nodes", "told"),
    [
        (["112/own", "111/sim"], "this domain, 112, has no other nodes; domain 111 has 1: go to 111"),
        (["7/a", "9/b", "7/c"], "this domain, 112, has no other nodes; domain 7 has 2, domain 9 has 1: go to N"),
        (["112/own", "112/other", "111/sim"], ""),
        (["112/own", "111/_hidden"], ""),
        ([], ""),
    ],
)
def test_a_domain_without_others(nodes: list[str], told: str) -> None:
    """Is told where others have nodes."""
    assert elsewhere(112, tokens(*nodes), "go to {}", ["/own"]) == told


@pytest.mark.parametrize(("type_", "found"), [("std_msgs/msg/String", {7}), ("std_msgs/msg/Int32", set())])
def test_a_counterpart_in_another_domain(type_: str, found: set[int]) -> None:
    """It has the same name and type: many programs have a topic of a common name."""
    own = Entity(0, "z", 1, 1, Kind.SUBSCRIPTION, "/", "ear", "/topic", "std_msgs/msg/String")
    other = Entity(7, "y", 1, 1, Kind.PUBLISHER, "/", "mouth", "/topic", type_, "RIHS01_0")
    assert with_counterpart([own], [other.token]) == found
