"""Completion of commands: verbs, their options, and names from the running graph."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from types import MappingProxyType

from textual.widgets import Input

from graphflow.console.views import ViewForm
from graphflow.errors import GraphflowError
from graphflow.introspect import completions
from graphflow.introspect.parameters import RemoteParameters
from graphflow.tui.feeds.hub import Hub, Verb, Verbs

TRANSITIONS = ("activate", "cleanup", "configure", "deactivate", "shutdown")
"""The lifecycle transitions that can be requested."""
REPLY_TIMEOUT = 1.0
"""Seconds to wait for a node's list of parameters."""


class Completer:
    """Completes commands, written without the word `graphflow`.

    Args:
        views: Further first words, each with the kind of its subject, such as `topic`.
    """

    def __init__(self, hub: Hub, views: Mapping[str, ViewForm] = MappingProxyType({})) -> None:
        self._hub, self._views = hub, views
        self._verbs: Verbs | None = None

    async def complete(self, line: str) -> tuple[str, list[str]]:
        """Complete the last word of a line as far as it is unambiguous.

        Returns:
            The line, and the candidates for its last word.
        """
        words = line.split()
        partial = words.pop() if words and not line.endswith(" ") else ""
        choices = sorted({c for c in await self._choices(words) if c.startswith(partial)})
        if not choices:
            return line, []
        common = _common(choices)
        head = line[: len(line) - len(partial)]
        if len(choices) == 1:
            return f"{head}{choices[0]} ", choices
        return head + common, choices

    async def _choices(self, words: list[str]) -> list[str]:
        if self._verbs is None:
            self._verbs = await asyncio.to_thread(self._hub.read_verbs)
        if not words:
            return [*self._verbs, *self._views]
        if len(words) == 1 and words[0] in self._views and words[0] not in self._verbs:
            return await self._named(self._views[words[0]].about.partition(".")[0], [])
        verbs, rest = self._verbs, list(words)
        while rest and rest[0] in verbs:
            verb = verbs[rest.pop(0)]
            if not verb.get("commands"):
                return await self._arguments(verb, rest)
            verbs = verb["commands"]
        return [] if rest else list(verbs)

    async def _arguments(self, verb: Verb, words: list[str]) -> list[str]:
        options = verb["options"]
        positional, skip = [], False
        for word in words:
            if skip:
                skip = False
            elif word.startswith("-"):
                skip = options.get(word, False)
            else:
                positional.append(word)
        if skip:
            return []
        arguments = verb["arguments"]
        names = [argument.strip("[].").removesuffix("]...") for argument in arguments]
        if not names or (len(positional) >= len(names) and not arguments[-1].endswith("...")):
            return list(options)
        kind = names[min(len(positional), len(names) - 1)]
        found = await self._named(kind, positional)
        return found or list(options)

    async def _named(self, kind: str, positional: list[str]) -> list[str]:
        live = self._hub.live
        if live is None:
            return []
        match kind.upper():
            case "NODE" | "NODES":
                return self._hub.nodes()
            case "PARAMETER" | "PARAMETERS" if positional:
                return await self._parameters(positional[0])
            case word if word in completions.MESSAGES and len(positional) >= 2:
                return completions.message(positional[1])
            case "HANDLER" if positional:
                return self._handlers(positional[0])
            case "TRANSITION":
                return list(TRANSITIONS)
        return completions.names_for(kind, positional, live.cache)

    def _handlers(self, node: str) -> list[str]:
        assert self._hub.live is not None
        report = self._hub.live.concurrency
        groups = report.nodes.get(node, []) if report is not None else []
        return [h["handler"] for g in groups for h in g["handlers"]]

    async def _parameters(self, node: str) -> list[str]:
        assert self._hub.live is not None
        try:
            return await self._hub.live.ask(lambda view: RemoteParameters(view, view.node(node), REPLY_TIMEOUT).names())
        except GraphflowError:
            return []


async def completed(line: Input, completer: Completer) -> tuple[str, list[str]]:
    """Complete the text of an input, keeping text typed meanwhile; return the result of `complete`."""
    before = line.value
    text, choices = await completer.complete(before)
    if line.value.startswith(before):
        line.value = text + line.value[len(before) :].lstrip(" " if text.endswith(" ") else "")
        line.cursor_position = len(line.value)
    return text, choices


def nothing_to_complete(text: str) -> str:
    """Return the message for a line without completions."""
    last = text.rpartition(" ")[2]
    return f"nothing here begins with {last!r}" if last else "there is nothing to complete here"


def _common(words: list[str]) -> str:
    """Return the longest common prefix."""
    first, last = min(words), max(words)
    return next((first[:i] for i, c in enumerate(first) if last[i : i + 1] != c), first)
