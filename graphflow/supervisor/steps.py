"""Steps: what a graph does once while it comes up."""

from __future__ import annotations

import os
from typing import Any

from graphflow.errors import ServiceUnavailable
from graphflow.graph.plan import PlannedStep
from graphflow.msgs import registry
from graphflow.msgs.values import from_plain
from graphflow.runtime.context import Context
from graphflow.runtime.core import core_of
from graphflow.runtime.node import Node
from graphflow.wire.liveliness import Kind


class StepRunner:
    """Makes the calls, under a hidden node of the supervisor.

    Args:
        types: Service types by step name, as far as the plan's classes say.
    """

    def __init__(self, context: Context, types: dict[str, str]) -> None:
        self._context = context
        self._types = types
        self._node: Node | None = None

    async def run(self, step: PlannedStep) -> Any:
        """Run a step; returns the response.

        Raises:
            CallError: The service is unavailable, failed, or did not answer within the step's timeout.
            EncodeError: The request does not fit the service's type.
        """
        if self._node is None:
            self._node = Node(f"_graphflow_{os.getpid()}", start_parameter_services=False, enable_rosout=False)
            await core_of(self._node).start(self._context)
        type_name = self._types.get(step.name) or await self._find_type(step)
        service: Any = registry.interface_class(type_name)
        request: Any = from_plain(service.Request, step.request)
        client = self._node.create_client(service, step.call)
        try:
            await client.expect_ready(step.timeout)
            return await client.call(request, timeout=step.timeout)
        finally:
            client.close()

    async def _find_type(self, step: PlannedStep) -> str:
        def servers() -> list[Any]:
            return self._context.cache.endpoints(Kind.SERVICE, step.call)

        try:
            async with self._context.clock.timeout(step.timeout):
                await self._context.wait_for(lambda: bool(servers()))
        except TimeoutError:
            raise ServiceUnavailable(f"no node offers the service {step.call}") from None
        return str(servers()[0].type)

    async def close(self) -> None:
        if self._node is not None:
            await core_of(self._node).stop()
