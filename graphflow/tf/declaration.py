"""The declaration of a node's transforms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self, overload

from graphflow.errors import DeclarationError
from graphflow.interface import EndpointInfo
from graphflow.runtime.call_site import here
from graphflow.runtime.declarations.creator import Maker
from graphflow.runtime.declarations.declare import Bound, Declaration
from graphflow.tf.buffer import STATIC_TOPIC, TOPIC, TYPE, TransformBuffer
from graphflow.times import to_ns


class Transforms(Declaration):
    """The transforms of the node: `await self.tf.lookup("map", "base_link")`, `self.tf.send(...)`.

    Args:
        cache: Seconds for which received transforms are kept.
        listen: Whether to receive transforms; False for a node that only sends.

    Raises:
        DeclarationError: `cache` is not a positive number of seconds.
    """

    MAKER = "declare tf = Transforms() in the class"

    def __init__(self, cache: float = 10.0, *, listen: bool = True) -> None:
        self.place = here()
        if isinstance(cache, bool) or not isinstance(cache, (int, float)) or not 0 < cache < 1e6:
            raise DeclarationError(
                f"{self.place}: Transforms: cache is a number of seconds such as 10.0, not {cache!r}"
            )
        self.cache, self.listen = cache, listen

    def endpoints(self) -> Sequence[EndpointInfo]:
        topics = (TOPIC, STATIC_TOPIC) if self.listen else ()
        return [EndpointInfo("subscription", name, TYPE, self.attribute, self.place) for name in topics]

    def create(self, maker: Maker) -> TransformBuffer:
        return TransformBuffer(maker.node, maker.owner, to_ns(self.cache), listen=self.listen, attribute=self.attribute)

    @overload
    def __get__(self, node: None, owner: type) -> Self: ...
    @overload
    def __get__(self, node: Bound, owner: type) -> TransformBuffer: ...
    def __get__(self, node: Bound | None, owner: type) -> object:
        return self if node is None else self.on(node)
