"""ROS 2's component services of a process, in graphs that allow control over the network.

They are services of the process's first node, as `~/_container/load_node` and so on, so that ROS 2's tools take that
node for the container.

Source: composition_interfaces; rclcpp_components component_manager.cpp.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.errors import GraphFileError, GraphflowError, printable
from graphflow.graph.plan import PlannedNode
from graphflow.names import Remap
from graphflow.qos import SERVICES
from graphflow.runtime.args import RosArgs
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.runtime.parameters.values import from_message
from graphflow.supervisor.control.orders import Orders
from graphflow.supervisor.launching.classes import import_class
from graphflow.supervisor.launching.joining import check_component, planned_component
from graphflow.workspace.executables import find

if TYPE_CHECKING:
    from graphflow.msgs.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
    from graphflow.supervisor.processes.messages import ProcessEvent

NAME_BOUND = 255
"""Longest name in a request, in characters."""
DESCRIPTION_BOUND = 3500
"""Largest description of a node in bytes: its event has to fit into PIPE_BUF."""
_LEVELS = {10: "debug", 20: "info", 30: "warn", 40: "error", 50: "fatal"}


class Container:
    """The component services of one process.

    Args:
        node: Its first node, not yet started.
        root: The folder that classes are imported from.
        report: Sends an event to the supervisor.
    """

    def __init__(
        self, node: Node, orders: Orders, process: str, root: str, report: Callable[[ProcessEvent], object]
    ) -> None:
        self._node, self._orders, self._process, self._root = node, orders, process, root
        self._report = report
        core = core_of(node)
        for name, type_name, answer in (
            ("load_node", "LoadNode", self._load),
            ("unload_node", "UnloadNode", self._unload),
            ("list_nodes", "ListNodes", self._list),
        ):
            core.serve(f"_container/{name}", f"composition_interfaces/srv/{type_name}", answer, SERVICES)

    async def _load(self, request: LoadNode.Request) -> LoadNode.Response:
        from graphflow.msgs.composition_interfaces.srv import LoadNode

        try:
            planned = self._planned(request)
            described = planned.to_json()
            if len(json.dumps(described)) > DESCRIPTION_BOUND:
                raise GraphflowError("it has too many parameters for this service; use graphflow component load")
            if planned.name in self._node.context.cache.nodes():
                raise GraphflowError(f"there is a node {planned.name} already")
            number, node = await self._orders.load(described)
        except Exception as error:  # loading runs user code, which may raise anything: the response carries it
            explain(error)
            text = str(error) if isinstance(error, GraphflowError) else f"{type(error).__name__}: {error}"
            text = printable(text)
            self._node.log.warning("%s could not be loaded: %s", printable(request.plugin_name[:NAME_BOUND]), text)
            return LoadNode.Response(success=False, error_message=text)
        joined = {**described, "name": node.full_name}
        self._report({"event": "joined", "process": self._process, "number": number, "node": joined})
        return LoadNode.Response(success=True, full_node_name=node.full_name, unique_id=number)

    def _planned(self, request: LoadNode.Request) -> PlannedNode:
        plugin = str(request.plugin_name)
        for text in (plugin, request.package_name, request.node_name, request.node_namespace, *request.remap_rules):
            if len(text) > NAME_BOUND:
                raise GraphflowError(
                    f"{text[:20]!r}... has {len(text)} characters; a name here has {NAME_BOUND} at most"
                )
        # `module:Class`, as graph files write it, as opposed to ROS 2's `package::Class`.
        if ":" in plugin.replace("::", ""):
            class_path = plugin
        else:
            found = find(request.package_name, plugin.rpartition("::")[2].lower(), Path(self._root))
            if found is None:
                raise GraphflowError(f"there is no {plugin!r} of the package {request.package_name!r} here")
            class_path = found.class_path
        interface = import_class(class_path).interface()
        ros = RosArgs(remaps=[Remap.parse(rule) for rule in request.remap_rules])
        ros.params = [(None, p.name, from_message(p.value), "a request") for p in request.parameters]
        name = request.node_name or interface.node_name
        level = _LEVELS.get(request.log_level, "")
        planned = planned_component(interface, name, request.node_namespace or "/", ros, level)
        problems = check_component(planned, interface)
        if problems:
            raise GraphFileError(problems)
        return planned

    async def _unload(self, request: UnloadNode.Request) -> UnloadNode.Response:
        from graphflow.msgs.composition_interfaces.srv import UnloadNode

        names = {number: name for name, number in self._orders.numbers.items()}
        name = names.get(request.unique_id, "")
        try:
            if not name:
                raise GraphflowError(f"there is no node {request.unique_id} in this process")
            if name == self._node.full_name:
                raise GraphflowError(f"{name} offers this service; to end it: graphflow component unload")
            await self._orders.unload(name)
        except GraphflowError as error:
            return UnloadNode.Response(success=False, error_message=str(error))
        self._report({"event": "left", "process": self._process, "node": name})
        return UnloadNode.Response(success=True)

    def _list(self, request: ListNodes.Request) -> ListNodes.Response:
        from graphflow.msgs.composition_interfaces.srv import ListNodes

        numbers = self._orders.numbers
        return ListNodes.Response(full_node_names=list(numbers), unique_ids=list(numbers.values()))
