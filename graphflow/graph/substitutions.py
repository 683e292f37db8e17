"""ROS's substitutions in texts: `$(var x)`, `$(env X default)`, `$(dirname)`, `$(eval ...)` and others, nested freely.

A value that is only `"$(var x)"` keeps the type of x; inside a longer text it becomes text.

Source: launch frontends, "Substitutions".
"""

from __future__ import annotations

import os
import shlex
import shutil
import zlib
from collections.abc import Callable, Mapping
from importlib import util
from pathlib import Path
from typing import Any

from graphflow.graph.expressions import ExpressionError, evaluate
from graphflow.names import did_you_mean

MAX_DEPTH = 20
MAX_TEXT = 100_000
"""Characters of a text, and bytes of a file that `$(file-content ...)` takes in."""


class SubstitutionError(ValueError):
    """A substitution is malformed, unknown, or has no value."""


class Substitutions:
    """What the substitutions of one file stand for.

    Args:
        args: Values of the file's arguments.
        folder: The folder of the file.
        env: The environment.
        package: Finds the folder of a package.
    """

    def __init__(
        self,
        args: Mapping[str, Any],
        folder: str,
        env: Mapping[str, str] | None = None,
        package: Callable[[str], str | None] | None = None,
    ) -> None:
        self._args = args
        self._folder = folder
        self._env = os.environ if env is None else env
        self._package = package or python_package

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
        texts = [_text(part) for part in parts]
        if sum(map(len, texts)) > MAX_TEXT:  # arguments made of arguments could grow without end
            raise SubstitutionError(f"the text has more than {MAX_TEXT:,} characters")
        return "".join(texts)

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
        text = "".join(_text(part) for part in self._parts(inside, depth + 1))
        name, _, rest = text.strip().partition(" ")
        function = _FUNCTIONS.get(name)
        if function is None:
            raise SubstitutionError(f"$({inside}): unknown substitution {name!r}{did_you_mean(name, _FUNCTIONS)}")
        return function(self, rest.strip())

    def _var(self, text: str) -> Any:
        words = text.split()
        if len(words) != 1:
            raise SubstitutionError("write $(var NAME)")
        name, *parts = words[0].split(".")
        if words[0] in self._args:
            name, parts = words[0], []
        if name not in self._args:
            help_ = did_you_mean(name, self._args) or "; declare it under args:"
            raise SubstitutionError(f"there is no argument {name!r}{help_}")
        value = self._args[name]
        for part in parts:
            if not isinstance(value, dict) or part not in value:
                near = did_you_mean(part, value) if isinstance(value, dict) else ""
                raise SubstitutionError(f"$(var {words[0]}): {name!r} has no {part!r}{near}")
            value = value[part]
        return value

    def _eval(self, text: str) -> Any:
        quote = text[:1]
        if quote in ("'", '"') and text[-1:] == quote and text.count(quote) == 2 and len(text) > 2:
            text = text[1:-1]  # as ROS's files write it
        try:
            return evaluate(text, self._args)
        except ExpressionError as error:
            raise SubstitutionError(f"$(eval {text[:60]}): {error}") from None

    def _environment(self, text: str) -> str:
        words = text.split(None, 1)
        if not words:
            raise SubstitutionError("write $(env NAME) or $(env NAME default)")
        if words[0] in self._env:
            return self._env[words[0]]
        if len(words) == 1:
            raise SubstitutionError(
                f"the environment variable {words[0]} is not set; give a default: $(env NAME default)"
            )
        return words[1]

    def _optional_environment(self, text: str) -> str:
        name, _, default = text.partition(" ")
        return self._env.get(name, default.strip())

    def _dirname(self, text: str) -> str:
        if text:
            raise SubstitutionError("write $(dirname)")
        return self._folder

    def _share(self, text: str) -> str:
        if len(text.split()) != 1:
            raise SubstitutionError("write $(find-pkg-share PACKAGE)")
        folder = self._package(text)
        if folder is None:
            raise SubstitutionError(f"$(find-pkg-share {text}): no package of that name is installed")
        return folder

    def _executable(self, text: str) -> str:
        found = shutil.which(text, path=self._env.get("PATH"))
        if found is None:
            raise SubstitutionError(f"$(find-exec {text}): there is no program of that name on the PATH")
        return found

    def _content(self, text: str) -> str:
        path = Path(self._folder) / text
        try:
            with path.open("rb") as file:
                data = file.read(MAX_TEXT + 1)
            content = data.decode()
        except (OSError, ValueError) as error:
            raise SubstitutionError(f"$(file-content {text}): {error}") from None
        if len(data) > MAX_TEXT:
            raise SubstitutionError(f"$(file-content {text}): the file is larger than {MAX_TEXT:,} bytes")
        return content

    def _anonymous(self, text: str) -> str:
        # The same word for the same name in a file: its nodes can be referred to.
        return f"{text}_{zlib.crc32(f'{self._folder} {os.getpid()} {text}'.encode()):08x}"

    def _refuse(self, text: str) -> Any:
        raise SubstitutionError(
            f"$(command {text[:60]}): programs are not run while a file is read; write what it prints into a file, and"
            " here $(file-content FILE)"
        )


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


def python_package(name: str) -> str | None:
    """The folder of an installed Python package; None if there is none of that name."""
    try:
        spec = util.find_spec(name) if name.isidentifier() else None
    except ValueError:  # a module that was not imported the usual way, such as __main__
        spec = None
    folders = list(spec.submodule_search_locations or []) if spec else []
    return str(Path(folders[0])) if folders else None


def truth(value: Any) -> bool:
    """A condition's value.

    Raises:
        SubstitutionError: It is neither true nor false.
    """
    words = {"true": True, "1": True, "false": False, "0": False}
    if isinstance(value, (bool, int)) and value in (0, 1):
        return bool(value)
    if isinstance(value, str) and value.strip().lower() in words:
        return words[value.strip().lower()]
    raise SubstitutionError(f"expected true or false, got {value!r}")


def _words(text: str, count: int, form: str) -> list[str]:
    try:
        words = shlex.split(text)
    except ValueError:
        words = []
    if len(words) != count:
        raise SubstitutionError(f"write $({form})")
    return words


_FUNCTIONS: dict[str, Callable[[Substitutions, str], Any]] = {
    "var": Substitutions._var,
    "env": Substitutions._environment,
    "optenv": Substitutions._optional_environment,
    "dirname": Substitutions._dirname,
    "find-pkg-share": Substitutions._share,
    "find-exec": Substitutions._executable,
    "file-content": Substitutions._content,
    "anon": Substitutions._anonymous,
    "eval": Substitutions._eval,
    "command": Substitutions._refuse,
    "not": lambda _, text: not truth(text),
    "and": lambda _, text: all(map(truth, _words(text, 2, "and A B"))),
    "or": lambda _, text: any(map(truth, _words(text, 2, "or A B"))),
    "equals": lambda _, text: len(set(_words(text, 2, "equals A B"))) == 1,
    "not-equals": lambda _, text: len(set(_words(text, 2, "not-equals A B"))) == 2,
}
"""What may stand behind `$(`, and how the rest is read."""
