"""ROS's substitutions in texts: `$(var x)`, `$(env X default)`, `$(dirname)`, `$(find-pkg-share p)`, nested freely.

A value that is only `"$(var x)"` keeps the type of x; inside a longer text it becomes text.

Source: launch frontends, "Substitutions".
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from importlib import util
from pathlib import Path
from typing import Any

from graphflow.names import did_you_mean

KNOWN = ("var", "env", "dirname", "find-pkg-share")
MAX_DEPTH = 20


class SubstitutionError(ValueError):
    """A substitution is malformed, unknown, or has no value."""


class Substitutions:
    """What the substitutions of one file stand for.

    Args:
        args: Values of the file's arguments.
        folder: The folder of the file.
        env: The environment.
    """

    def __init__(self, args: Mapping[str, Any], folder: str, env: Mapping[str, str] | None = None) -> None:
        self._args = args
        self._folder = folder
        self._env = os.environ if env is None else env
        self.used: set[str] = set()
        """Arguments that were used."""

    def apply(self, value: Any) -> Any:
        """The value with every substitution in it made; a text that is one substitution takes its type.

        Raises:
            SubstitutionError: A substitution cannot be made.
        """
        if not isinstance(value, str) or "$(" not in value:
            return value
        parts = self._parts(value, 1)
        if len(parts) == 1:
            return parts[0]
        return "".join(_text(part) for part in parts)

    def _parts(self, text: str, depth: int) -> list[Any]:
        if depth > MAX_DEPTH:
            raise SubstitutionError(f"substitutions nested more than {MAX_DEPTH} deep")
        parts: list[Any] = []
        position = 0
        while (start := text.find("$(", position)) >= 0:
            if start > position:
                parts.append(text[position:start])
            end = _closing(text, start)
            parts.append(self._evaluate(text[start + 2 : end], depth))
            position = end + 1
        if position < len(text):
            parts.append(text[position:])
        return parts

    def _evaluate(self, inside: str, depth: int) -> Any:
        words = "".join(_text(part) for part in self._parts(inside, depth + 1)).split(None, 2)
        name = words[0] if words else ""
        functions: dict[str, Callable[[list[str]], Any]] = {
            "var": self._var,
            "env": self._environment,
            "dirname": self._dirname,
            "find-pkg-share": self._share,
        }
        if name not in functions:
            raise SubstitutionError(f"$({inside}): unknown substitution {name!r}{did_you_mean(name, KNOWN)}")
        return functions[name](words[1:])

    def _var(self, words: list[str]) -> Any:
        if len(words) != 1:
            raise SubstitutionError("write $(var NAME)")
        if words[0] not in self._args:
            help_ = did_you_mean(words[0], self._args) or "; declare it under args:"
            raise SubstitutionError(f"there is no argument {words[0]!r}{help_}")
        self.used.add(words[0])
        return self._args[words[0]]

    def _environment(self, words: list[str]) -> str:
        if not words:
            raise SubstitutionError("write $(env NAME) or $(env NAME default)")
        if words[0] in self._env:
            return self._env[words[0]]
        if len(words) == 1:
            raise SubstitutionError(
                f"the environment variable {words[0]} is not set; give a default: $(env NAME default)"
            )
        return " ".join(words[1:])

    def _dirname(self, words: list[str]) -> str:
        if words:
            raise SubstitutionError("write $(dirname)")
        return self._folder

    def _share(self, words: list[str]) -> str:
        if len(words) != 1:
            raise SubstitutionError("write $(find-pkg-share PACKAGE)")
        try:
            spec = util.find_spec(words[0]) if words[0].isidentifier() else None
        except ValueError:  # a module that was not imported the usual way, such as __main__
            spec = None
        folders = list(spec.submodule_search_locations or []) if spec else []
        if not folders:
            raise SubstitutionError(f"$(find-pkg-share {words[0]}): no package of that name is installed")
        return str(Path(folders[0]))


def _closing(text: str, start: int) -> int:
    """The index of the parenthesis that closes the one at `start + 1`."""
    depth = 0
    for i in range(start + 1, len(text)):
        depth += {"(": 1, ")": -1}.get(text[i], 0)
        if depth == 0:
            return i
    raise SubstitutionError(f"{text[start : start + 40]!r} has no closing )")


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)
