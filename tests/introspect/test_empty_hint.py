"""Hints of an empty listing at other domains."""

from __future__ import annotations

from typing import Self

import pytest

from graphflow.introspect import empty_hint
from graphflow.introspect.empty_hint import ANSWER_LIMIT, nothing_here, why_silent
from graphflow.introspect.lifecycles import Idle
from graphflow.wire.liveliness import Entity, Kind


class Seen:
    """A client with invented tokens."""

    tokens_: list[str] = []  # noqa: RUF012

    def tokens(self, key: str) -> list[str]:
        assert key == "@ros2_lv/*/*/*/*/NN/**"
        return self.tokens_

    def close(self) -> None:
        """Nothing is open."""


@pytest.mark.parametrize(
    ("nodes", "text"),
    [
        ([], "and none in others"),
        (
            ["0/a", "0/b", "5/_hidden", "0/_hidden"],
            "there are 2 nodes in domain 0: graphflow --domain 0 ...",
        ),
        (
            ["9/a", "7/b", "7/c"],
            "there are 2 nodes in domain 7, 1 node in domain 9: graphflow --domain N ...",
        ),
        (
            ["9/a"],
            "there is 1 node in domain 9: graphflow --domain 9 ...",
        ),
    ],
)
def test_where_nodes_run(nodes: list[str], text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By domain; hidden ones do not count."""
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "5")
    monkeypatch.setattr(empty_hint, "Client", Seen)
    Seen.tokens_ = [f"@ros2_lv/{n.split('/')[0]}/z/{i}/{i}/NN/%/%/{n.split('/')[1]}" for i, n in enumerate(nodes)]
    assert nothing_here("no nodes") == f"no nodes in domain 5{', ' if text.startswith('and') else '; '}{text}"


class View:
    """Knows why one topic is silent, and the publisher of another."""

    def __init__(self, domain: int) -> None:
        self.cache = self
        self.reasons = {"/b": "a net profile"}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing is open."""

    def endpoints(self, kind: Kind, name: str = "") -> list[Entity]:
        node = Entity(0, "a1", 0, 1, kind, "/", "camera", name, "std_msgs/msg/String", "RIHS01_0")
        return [node] if name == "/image" else []

    def why_silent(self, topic: str) -> str:
        return self.reasons.get(topic, "")


def test_topics_without_messages(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first reason that is known: a net profile, or a publisher that is not active."""

    def idle(_: object, limit: float, among: set[str]) -> Idle:
        assert limit == ANSWER_LIMIT
        return Idle([f"{name} is unconfigured" for name in ("/lidar", "/camera") if name in among], [])

    monkeypatch.setattr(empty_hint, "View", View)
    monkeypatch.setattr(empty_hint, "idle", idle)
    assert why_silent(["/a", "/b"]) == "a net profile"
    assert why_silent(["/a", "/image", "/b"]) == "/camera is unconfigured"
    assert why_silent(["/a"]) == ""
