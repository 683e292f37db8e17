"""The choice of topics of a graph or of a bag."""

from __future__ import annotations

import re
from dataclasses import dataclass

from graphflow.names import is_hidden

EVENTS = "/_service_event"
"""The suffix of the topic on which service introspection publishes calls."""


@dataclass(frozen=True)
class Choice:
    """The requested topics: `all`, or by name, type or pattern, less the excluded ones."""

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
    """Whether `all`, a type or a pattern may include hidden topics."""

    def wants(self, name: str, type_name: str) -> bool:
        """Return whether a topic is chosen. A topic chosen by name is not excluded by pattern or type."""
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
