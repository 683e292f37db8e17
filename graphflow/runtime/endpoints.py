"""What all endpoints of a node have in common: a full name, a token in the graph, and a life."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from graphflow.errors import ClosedError
from graphflow.msgs import registry
from graphflow.qos import Qos
from graphflow.transport.base import Closable
from graphflow.wire.liveliness import Entity, Kind

if TYPE_CHECKING:
    from graphflow.runtime.node import Node


class Endpoint(ABC):
    """What a node holds on the network under one name, from `open` to `close`."""

    kind: Kind

    def __init__(self, node: Node, type_name: str, name: str, qos: Qos) -> None:
        self.node = node
        self.type_name = type_name
        self.name = name
        """The full, remapped name."""
        self.qos = qos
        self.entity: Entity | None = None
        """How the endpoint is announced; None until the node runs."""
        self._declared: list[Closable] = []

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name} [{self.type_name}]>"

    @property
    def is_open(self) -> bool:
        return self.entity is not None

    def open(self) -> None:
        """Declare it on the network and announce it. Done by the node."""
        context, node = self.node.context, self.node
        self.entity = Entity(
            context.domain,
            context.session.zid,
            node.id,
            context.next_id(),
            self.kind,
            node.namespace,
            node.name,
            self.name,
            self.type_name,
            registry.hash_of(self.type_name),
            self.qos,
        )
        self._open(self.entity.data_key)
        # After the declaration, so that whoever sees the token can reach what it announces.
        self._declared.append(context.session.announce(self.entity.token))

    @abstractmethod
    def _open(self, key: str) -> None:
        """Declare it on the network under its data key."""

    def close(self) -> None:
        """Withdraw it from the network. Closing twice is harmless."""
        declared, self._declared = self._declared, []
        for closable in reversed(declared):
            closable.close()
        self.entity = None
        self.node.forget(self)

    def _announced(self) -> Entity:
        if self.entity is None:
            raise ClosedError(
                f"{self.name}: node {self.node.full_name} is not running; use this from its handlers and tasks"
            )
        return self.entity
