"""ROS arguments without effect: remaps, parameters and parameter files for names that no node has.

ROS 2 ignores them silently, so a misspelt name goes unnoticed. They are reported once nodes have had time to create
their entities, or when the first node leaves.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.graph import params_file
from graphflow.names import Remap, did_you_mean, nearest, rule_hint
from rclpy.impl.failing import failure
from rclpy.impl.nodes import internals_of, nodes_of

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.node import Node

WARN_AFTER = 3.0
"""Seconds from the first spin of a node."""
_EVERY_NODES = {"use_sim_time", "start_type_description_service"}
"""Parameters that every node has."""
_OVERRIDES = "qos_overrides."
"""The prefix of parameters that only nodes with such overrides declare."""
logger = logging.getLogger("graphflow")


class Unused:
    """The ROS arguments of one context that no node has used."""

    def __init__(self, life: ContextState) -> None:
        args = life.args
        self._life = life
        self._is_reported = not (args.remaps or args.params or args.params_files)
        self._since: float | None = None
        self._files = [params_file.read(Path(file), file) for file in args.params_files]
        life.on_leaving.append(self._report)

    def check(self) -> None:
        """Report the unused arguments when it is time."""
        if self._is_reported:
            return
        if self._since is None and any(internals_of(node).times_added for node in self._nodes()):
            self._since = time.monotonic()
        if self._since is not None and time.monotonic() - self._since >= WARN_AFTER:
            self._report()

    def _nodes(self) -> list[Node]:
        return nodes_of(self._life)

    def _report(self, leaving: Node | None = None) -> None:
        if not self._is_reported:
            self._is_reported = True
            if isinstance(failure(), Exception):
                return  # a failing program may not have created the entities that they are for
            nodes = [*self._nodes(), *([] if leaving is None else [leaving])]
            for text in (*self._remaps(nodes), *self._params(nodes), *self._strays(nodes)):
                logger.warning("%s", text)

    def _remaps(self, nodes: list[Node]) -> Iterator[str]:
        resolvers = [internals_of(node).core.names for node in nodes]
        used = {rule for names in resolvers for rule in names.used}
        known = [name for node in nodes for name in _names(node)]
        params = {name for node in nodes for name in internals_of(node).parameters.names}
        for rule in self._life.args.remaps:
            if rule not in used and (former := next(filter(None, (n.taken_by(rule) for n in resolvers)), None)):
                yield f"the remap {rule} comes too late: {former} has renamed {rule.match} already; remove one"
            elif rule not in used:
                own = {node.get_name() for node in nodes}
                way = f"; to rename the node: -r __node:={rule.replacement}" if rule.match in own else ""
                way = way or _intended(rule, params, known)
                yield f"the remap {rule} matches no name of {_listed(nodes)}{way}"

    def _params(self, nodes: list[Node]) -> Iterator[str]:
        for target, name, value, _ in self._life.args.params:
            of = [n for n in nodes if target in (None, n.get_name(), n.get_fully_qualified_name())]
            held = [internals_of(n).parameters for n in of]
            if target is not None and not of:
                yield f"-p {target}:{name} matches no node{did_you_mean(target, [n.get_name() for n in nodes])}"
            elif not any(params.allows_undeclared or name in params.names for params in held):
                known = [known for params in held for known in params.names - _EVERY_NODES]
                yield f"-p {name}:={value} sets nothing: {_listed(of)} declares no such parameter{_near(name, known)}"

    def _strays(self, nodes: list[Node]) -> Iterator[str]:
        names = [internals_of(node).node.full_name for node in nodes]
        for sections in self._files:
            if not any(section.fits(name) for section in sections for name in names):
                yield "; ".join(map(str, params_file.strays(sections, names)))
            yield from (text for section in sections for text in self._undeclared(section, nodes))

    def _undeclared(self, section: params_file.Section, nodes: list[Node]) -> Iterator[str]:
        """Report a section's parameters that none of its nodes declares; sections for many nodes may have others'."""
        of = [node for node in nodes if section.fits(node.get_fully_qualified_name())]
        held = [internals_of(node).parameters for node in of]
        if any(params.allows_undeclared for params in held):
            return
        known = list({name: None for params in held for name in params.names - _EVERY_NODES})
        for name, setting in section.params.items() if of else ():
            is_set = name in known or name in _EVERY_NODES or name.startswith(_OVERRIDES)
            if not is_set and (section.is_exact or nearest(name, known) is not None):
                text = f"{name} sets nothing: {_listed(of)} declares no such parameter{did_you_mean(name, known)}"
                yield f"{setting.place}: {text}"


def _intended(rule: Remap, params: set[str], known: list[str]) -> str:
    if rule.match in params:
        return f"; to set the parameter: -p {rule}"
    return rule_hint(rule.match, rule.replacement, known) or _near(rule.match, known)


def _near(word: str, known: list[str]) -> str:
    return did_you_mean(word, dict.fromkeys(known))


def _names(node: Node) -> Iterator[str]:
    """Return the names, relative to the node's namespace, that its own code gives to topics, services and actions."""
    inner = internals_of(node)
    space = inner.node.namespace.rstrip("/") + "/"
    topics = [*(p.topic_name for p in inner.publishers), *(s.topic_name for s in inner.subscriptions)]
    services = [*(c.service_name for c in inner.clients), *(s.service_name for s in inner.services)]
    for name in (*topics, *services):
        if not name.startswith((f"{inner.node.full_name}/", "/rosout", "/parameter_events")):
            yield name.removeprefix(space)


def _listed(nodes: list[Node]) -> str:
    return " or ".join(internals_of(node).node.full_name for node in nodes)
