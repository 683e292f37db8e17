"""ROS arguments without effect: remaps, parameters and parameter files for names that no node has.

ROS 2 ignores them silently, so a misspelt name goes unnoticed. They are reported once nodes have had time to create
their entities, or when the first node leaves.
"""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graphflow.graph import params_file
from graphflow.names import Remap, did_you_mean, whole_rule

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState

TELL_AFTER = 3.0
"""Seconds from the first spin of a node."""
_EVERY_NODES = {"use_sim_time", "start_type_description_service"}
"""Parameters that every node has."""
logger = logging.getLogger("graphflow")


class Unused:
    """The ROS arguments of one context that no node has used."""

    def __init__(self, life: ContextState) -> None:
        args = life.args
        self._life = life
        self._is_told = not (args.remaps or args.params or args.params_files)
        self._since: float | None = None
        self._files = [params_file.read(Path(file), file) for file in args.params_files]
        life.on_leaving.append(self._tell)

    def look(self) -> None:
        """Report the unused arguments when it is time."""
        if self._is_told:
            return
        if self._since is None and any(node._graphflow.times_added for node in self._nodes()):
            self._since = time.monotonic()
        if self._since is not None and time.monotonic() - self._since >= TELL_AFTER:
            self._tell()

    def _nodes(self) -> list[Any]:
        return list(self._life.nodes)

    def _tell(self, leaving: object = None) -> None:
        if not self._is_told:
            self._is_told = True
            if isinstance(sys.exc_info()[1] or getattr(sys, "last_value", None), Exception):
                return  # the program ends in an error, before it has made all that they are for
            nodes = [*self._nodes(), *([] if leaving is None else [leaving])]
            for text in (*self._remaps(nodes), *self._params(nodes), *self._strays(nodes)):
                logger.warning("%s", text)

    def _remaps(self, nodes: list[Any]) -> Iterator[str]:
        resolvers = [node._graphflow.core.names for node in nodes]
        used = {rule for names in resolvers for rule in names.used}
        known = [name for node in nodes for name in _names(node)]
        params = {name for node in nodes for name in node._graphflow.parameters.names}
        for rule in self._life.args.remaps:
            if rule not in used:
                own = {node.get_name() for node in nodes}
                way = f"; to rename the node: -r __node:={rule.replacement}" if rule.match in own else ""
                way = way or _meant(rule, params, known)
                yield f"the remap {rule} matches no name of {_listed(nodes)}{way}"

    def _params(self, nodes: list[Any]) -> Iterator[str]:
        for target, name, value, _ in self._life.args.params:
            of = [n for n in nodes if target in (None, n.get_name(), n.get_fully_qualified_name())]
            held = [n._graphflow.parameters for n in of]
            if target is not None and not of:
                yield f"-p {target}:{name} is for no node here{did_you_mean(target, [n.get_name() for n in nodes])}"
            elif not any(params.allows_undeclared or name in params.names for params in held):
                known = [known for params in held for known in params.names - _EVERY_NODES]
                yield f"-p {name}:={value} sets nothing: {_listed(of)} declares no such parameter{_near(name, known)}"

    def _strays(self, nodes: list[Any]) -> Iterator[str]:
        names = [node._graphflow.node.full_name for node in nodes]
        for sections in self._files:
            if not any(section.fits(name) for section in sections for name in names):
                yield "; ".join(map(str, params_file.strays(sections, names)))


def _meant(rule: Remap, params: set[str], known: list[str]) -> str:
    if rule.match in params:
        return f"; to set the parameter: -p {rule}"
    return whole_rule(rule.match, rule.replacement, known) or _near(rule.match, known)


def _near(word: str, known: list[str]) -> str:
    return did_you_mean(word, dict.fromkeys(known))


def _names(node: Any) -> Iterator[str]:
    """Return the names, relative to the node's namespace, that its own code gives to topics, services and actions."""
    inner = node._graphflow
    space = inner.node.namespace.rstrip("/") + "/"
    own = [*inner.publishers, *inner.subscriptions, *inner.clients, *inner.services]
    for entity in own:
        name = str(getattr(entity, "topic_name", None) or entity.service_name)
        if not name.startswith((f"{inner.node.full_name}/", "/rosout", "/parameter_events")):
            yield name.removeprefix(space)


def _listed(nodes: list[Any]) -> str:
    return " or ".join(node._graphflow.node.full_name for node in nodes)
