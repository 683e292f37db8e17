"""Which topics of a graph or of a bag are meant."""

from __future__ import annotations

import re
from dataclasses import dataclass

from graphflow.names import is_hidden

EVENTS = "/_service_event"
"""The end of the topic on which a service with introspection tells of its calls."""


@dataclass(frozen=True)
class Choice:
    """What was asked for: `all`, or by name, type or pattern, less what is excluded."""

    all: bool = False
    topics: frozenset[str] = frozenset()
    """Full names."""
    types: frozenset[str] = frozenset()
    regex: str = ""
    services: frozenset[str] = frozenset()
    all_services: bool = False
    exclude: frozenset[str] = frozenset()
    exclude_types: frozenset[str] = frozenset()
    exclude_regex: str = ""
    exclude_services: frozenset[str] = frozenset()
    hidden: bool = False
    """Whether `all`, a type or a pattern may mean hidden topics."""

    def wants(self, name: str, type_name: str) -> bool:
        """Whether a topic is meant. What was named is meant though it matches what is excluded by pattern or type."""
        if name.endswith(EVENTS):
            service = name.removesuffix(EVENTS)
            return service in self.services or (
                self.all_services and service not in self.exclude_services and (self.hidden or not is_hidden(service))
            )
        if name in self.exclude:
            return False
        if name in self.topics:
            return True
        if (self.exclude_regex and re.search(self.exclude_regex, name)) or type_name in self.exclude_types:
            return False
        if is_hidden(name) and not self.hidden:
            return False
        return self.all or type_name in self.types or bool(self.regex and re.search(self.regex, name))
