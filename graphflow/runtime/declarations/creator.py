"""A node, as the declarations of its class use it to create their runtime objects."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

from graphflow.names import Resolver
from graphflow.runtime.endpoints.timer import Timer
from graphflow.runtime.parameters.params import Parameters
from graphflow.runtime.part import Host, Part

P = TypeVar("P", bound=Part)


class Creator(Protocol):
    """The methods of a node that create its endpoints."""

    @property
    def create_publisher(self) -> Callable[..., object]: ...

    @property
    def create_subscription(self) -> Callable[..., object]: ...

    @property
    def create_service(self) -> Callable[..., object]: ...

    @property
    def create_client(self) -> Callable[..., object]: ...

    @property
    def create_action_server(self) -> Callable[..., object]: ...

    @property
    def create_action_client(self) -> Callable[..., object]: ...

    @property
    def create_timer(self) -> Callable[..., Timer]: ...


class Owner(Host, Protocol):
    """A node's core, which takes the parts of declarations that are more than one endpoint."""

    names: Resolver
    parameters: Parameters
    transforms: set[str]

    def add(self, part: P, *, late: bool = False) -> P:
        """Add a part, and open it if it is due."""


class Maker(Protocol):
    """The node of which a declaration makes its runtime object.

    Attributes:
        node: The node, with its `create_*` methods.
        owner: The node's core.
    """

    @property
    def node(self) -> Creator: ...

    @property
    def owner(self) -> Owner: ...

    def method(self, fn: object) -> object:
        """Return a function of the class body as the node's method, which a subclass may have overridden."""
