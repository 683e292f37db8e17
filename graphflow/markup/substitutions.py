"""ROS's substitutions in texts: `$(var x)`, `$(env X default)`, `$(dirname)`, `$(eval ...)` and others, nested freely.

A value that is only `"$(var x)"` has the type of x; within a longer text it becomes text.

Source: launch frontends, "Substitutions".
"""

from __future__ import annotations

import math
import os
import re
import shlex
import shutil
import zlib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from graphflow.markup import ros1_words
from graphflow.markup.copies import copy_of
from graphflow.markup.expressions import ExpressionError, evaluate, with_quotes
from graphflow.markup.param_types import as_type, from_yaml
from graphflow.markup.source import Data, scalar
from graphflow.markup.substitution_words import UnclosedError, Word, as_argument, as_word, quoted, spans, words
from graphflow.names import did_you_mean
from graphflow.reading import found_bytes
from graphflow.workspace.executables import package_prefix, package_program, package_share
from graphflow.workspace.packages import find_workspace
from graphflow.workspace.unfound import why_no_package

MAX_DEPTH = 20
MAX_TEXT = 100_000
"""Characters of a text, and bytes of a file that a substitution reads, or that `$(command ...)` prints."""
ON_STDERR = ("fail", "ignore", "warn", "capture")
"""Treatments of the error output of a program of `$(command ...)`."""
_VALUES = re.compile(r"""(['"]?)\$\(var (\w+)\)\1""")
"""The value of an argument in an expression."""


_YAML_1_1 = {"yes": True, "on": True, "no": False, "off": False}
"""Words for truth values in YAML 1.1 alone."""
_OCTAL = re.compile(r"[-+]?0[0-7]+")
"""An octal number of YAML 1.1."""


class SubstitutionError(ValueError):
    """A substitution is malformed, unknown, or has no value."""


class Written(str):
    """The value of a launch file's argument: a text, as all are in ROS, which is parsed where a value is needed."""

    @property
    def value(self) -> Data:
        """The YAML 1.1 value of the text, as ROS reads it; an empty text stays one."""
        if self.lower() in _YAML_1_1:
            return _YAML_1_1[self.lower()]
        try:
            if _OCTAL.fullmatch(self):
                return int(self, 8)
            value = from_yaml(self) if self[:1] in ("[", "'", '"') else scalar(self) if self else ""
        except ValueError:  # a number with too many digits
            return str(self)
        return str(value) if isinstance(value, str) else value


Run = Callable[[list[str], str, Path, Mapping[str, str]], str]
"""Runs a program in a folder and returns its output; the second argument is one of `ON_STDERR`."""


class Outside(NamedTuple):
    """The environment of substitutions: everything outside their file."""

    env: Mapping[str, str] = os.environ
    root: Path = Path()
    """The project's folder."""
    logs: Path = Path()
    """The folder of the logs."""
    run: Run | None = None
    """Runs the programs of `$(command ...)`; without it, such a substitution stays as it is."""

    def with_env(self, variables: Mapping[str, str]) -> Outside:
        """Return the same with more environment variables."""
        return Outside({**self.env, **variables}, self.root, self.logs, self.run)


class Substitutions:
    """The substitutions of one file.

    Args:
        args: Values of the file's arguments.
        file: The file.
        outside: The environment.
        params: Values of the parameters that the surrounding groups give to all nodes.
        is_launch: Whether it is a launch file, in which the values of expressions are texts: `True`, not `true`.
    """

    def __init__(
        self,
        args: Mapping[str, Data],
        file: Path,
        outside: Outside,
        params: Mapping[str, Data] | None = None,
        *,
        is_launch: bool = False,
    ) -> None:
        self._args = args
        self._file = file
        self._is_launch = is_launch
        self._env, self._root, self._logs, self._run = outside
        self._params = params or {}

    def apply(self, value: Data, *, is_word: bool = False) -> Data:
        """Make every substitution in a value; a text that is a single substitution takes its type.

        Args:
            is_word: Whether the value stays text, as a word of a command line does.

        Raises:
            SubstitutionError: A substitution cannot be made.
        """
        if not isinstance(value, str) or "$(" not in value:
            return value
        parts = self._parts(value, 1)
        if len(parts) == 1 and not is_word:
            [part] = parts
            return part.value if isinstance(part, Written) else part
        texts = [_text(part) for part in parts]
        # The limit is checked at every step, so that no intermediate text becomes much longer.
        if sum(map(len, texts)) > MAX_TEXT:  # arguments made of arguments could grow without end
            raise SubstitutionError(f"the text has more than {MAX_TEXT:,} characters")
        return "".join(texts)

    def _parts(self, text: str, depth: int, *, is_word: bool = False) -> list[Data]:
        if depth > MAX_DEPTH:
            raise SubstitutionError(f"substitutions nested more than {MAX_DEPTH} deep")
        try:
            parts = list(spans(text, is_word=is_word))
        except UnclosedError as error:
            raise SubstitutionError(f"{str(error)!r} has no closing )") from None
        return [self._evaluate(part, depth) if is_inside else part for part, is_inside in parts]

    def _evaluate(self, inside: str, depth: int) -> Data:
        name, _, rest = inside.strip().partition(" ")
        function = _FUNCTIONS.get(name)
        if function is None:
            near = f"; write $(var {name})" if name in self._args else did_you_mean(name, _FUNCTIONS)
            if former := ros1_words.substitution(inside):
                near = f" of ROS 1's; {former}"
            raise SubstitutionError(f"$({inside}): unknown substitution {name!r}{near}")
        try:
            written = words(rest)
        except UnclosedError as error:
            if name != "eval":
                text = f"$({inside}): the quote in {str(error)!r} is not closed, or no space follows it"
                raise SubstitutionError(text) from None
            written = []
        if name == "eval" and not (len(written) in (1, 2) and written[0].is_quoted):
            # Quotes other than those around the whole expression belong to it.
            try:
                return self._eval([Word(self._joined(rest.strip(), depth + 1), is_quoted=False)])
            except SubstitutionError as error:
                way = self._by_name(rest.strip())
                raise SubstitutionError(f"{str(error).partition('; ')[0]}{way}" if way else str(error)) from None
        return function(self, [Word(self._joined(w.text, depth + 1, is_word=True), w.is_quoted) for w in written])

    def _by_name(self, expression: str) -> str:
        """Return a hint for an expression that has `$(var x)` where it could name x; empty if that is not the fault."""
        found = [name for _, name in _VALUES.findall(expression)]
        if not found or not {*found} <= self._args.keys():
            return ""
        if any(
            isinstance(self._args[name], Written) for name in found
        ):  # arguments of a launch file: ROS has no names in expressions
            expression = with_quotes(_VALUES.sub(r"'$(var \2)'", expression).replace('"', "'"))
            pieces = re.sub(r"\$\(var (\w+)\)", r'", LaunchConfiguration("\1"), "', expression)
            return f'; write $(eval "{expression}"), in Python PythonExpression(["{pieces}"])'
        expression = _VALUES.sub(lambda value: value[2], expression)
        try:
            self._eval([Word(expression, is_quoted=False)])
        except SubstitutionError:  # something else is wrong
            return ""
        return f"; write $(eval {expression})"

    def _joined(self, text: str, depth: int, *, is_word: bool = False) -> str:
        return "".join(map(_text, self._parts(text, depth, is_word=is_word)))

    def _var(self, given: list[Word]) -> Data:
        if not given:
            raise SubstitutionError("write $(var NAME), or $(var NAME DEFAULT)")
        word, default = given[0].text, given[1:]
        name, *parts = word.split(".")
        if word in self._args:
            name, parts = word, []
        if name not in self._args and default:
            return _default(default)
        if name not in self._args:
            help_ = did_you_mean(name, self._args) or "; declare it, under args: or by DeclareLaunchArgument"
            raise SubstitutionError(f"there is no argument {name!r}{help_}")
        value = self._args[name]
        for part in parts:
            if not isinstance(value, dict) or part not in value:
                near = did_you_mean(part, value) if isinstance(value, dict) else ""
                raise SubstitutionError(f"$(var {word}): {name!r} has no {part!r}{near}")
            value = value[part]
        return value

    def _eval(self, given: list[Word]) -> Data:
        text = given[0].text
        try:
            values = {name: arg.value if isinstance(arg, Written) else arg for name, arg in self._args.items()}
            found = evaluate(text, values)
        except ExpressionError as error:
            raise SubstitutionError(f"$(eval {text[:60]}): {error}") from None
        return Written(found) if self._is_launch else found

    def _environment(self, given: list[Word]) -> str:
        if not given:
            raise SubstitutionError("write $(env NAME) or $(env NAME default)")
        name, *default = given
        if name.text not in self._env and not default:
            raise SubstitutionError(
                f"the environment variable {name.text} is not set; give a default: $(env NAME default)"
            )
        return self._env.get(name.text, _joined(default))

    def _optional_environment(self, given: list[Word]) -> str:
        return self._env.get(_joined(given[:1]), _joined(given[1:]))

    def _dirname(self, given: list[Word]) -> str:
        _words(given, 0, "dirname")
        return str(self._file.parent)

    def _filename(self, given: list[Word]) -> str:
        _words(given, 0, "filename")
        return str(self._file)

    def _log_folder(self, given: list[Word]) -> str:
        _words(given, 0, "log_dir")
        return str(self._logs)

    def _share(self, given: list[Word]) -> str:
        [package] = _words(given, 1, "find-pkg-share PACKAGE")
        return _found(package_share(package, self._root, self._env), package, f"find-pkg-share {package}", self._root)

    def _prefix(self, given: list[Word]) -> str:
        [package] = _words(given, 1, "find-pkg-prefix PACKAGE")
        return _found(package_prefix(package, self._root, self._env), package, f"find-pkg-prefix {package}", self._root)

    def _program(self, given: list[Word]) -> str:
        program, package = _words(given, 2, "exec-in-pkg EXECUTABLE PACKAGE")
        written = f"exec-in-pkg {program} {package}"
        _found(package_share(package, self._root, self._env), package, written, self._root)
        found = package_program(program, package, self._root, self._env)
        if found is None:
            raise SubstitutionError(
                f"$({written}): there is no such program in the package; for a node write pkg: and exec:"
            )
        return str(found)

    def _param(self, given: list[Word]) -> Data:
        name, *default = _words(given, (1, 2), "param NAME DEFAULT")
        if name not in self._params and default:
            return _default(given[1:])
        if name not in self._params:
            near = did_you_mean(name, self._params)
            raise SubstitutionError(f"no group around this gives a parameter {name!r} to its nodes{near}")
        return self._params[name]

    def _executable(self, given: list[Word]) -> str:
        text = _joined(given)
        found = shutil.which(text, path=self._env.get("PATH"))
        if found is None:
            raise SubstitutionError(f"$(find-exec {text}): there is no program of that name on the PATH")
        return found

    def _content(self, given: list[Word]) -> str:
        text = _joined(given)
        return self._read(text, f"$(file-content {text})")

    def _read(self, path: str, written: str) -> str:
        try:
            return found_bytes(self._file.parent / path, MAX_TEXT).decode()
        except (OSError, ValueError) as error:
            raise SubstitutionError(f"{written}: {error}") from None

    def _substituted(self, given: list[Word]) -> str:
        """Return the path of a copy of a file with its substitutions made; comments are dropped."""
        text = _joined(given)
        written = f"$(substituted {text})"
        lines = self._read(text, written).splitlines(keepends=True)
        content = "".join("\n" if line.lstrip().startswith("#") else line for line in lines)
        if "$(" not in content:
            return str(self._file.parent / text)
        if "$(substituted " in content:  # it could be of itself
            raise SubstitutionError(f"{written}: the file has a substitution of this kind itself")
        try:
            return str(copy_of(str(self.apply(content, is_word=True)), Path(text).name))
        except OSError as error:
            raise SubstitutionError(f"{written}: {error}") from None

    def _anonymous(self, given: list[Word]) -> str:
        text = _joined(given)
        # The same result for the same name throughout a file, so that other actions can refer to the node.
        return f"{text}_{zlib.crc32(f'{self._file.parent} {os.getpid()} {text}'.encode()):08x}"

    def _command(self, given: list[Word]) -> str:
        """Return the output of a program. As in ROS, a quoted command may be followed by one of `ON_STDERR`."""
        texts = [word.text for word in given]
        on_stderr = texts.pop() if len(texts) == 2 and texts[1] in ON_STDERR else "fail"
        try:
            words = shlex.split(texts[0]) if len(texts) == 1 else texts
        except ValueError:  # a quote that is not closed
            words = []
        if not words:
            raise SubstitutionError(f"write $(command 'PROGRAM ...') or $(command 'PROGRAM ...' {'|'.join(ON_STDERR)})")
        if self._run is None:
            return f"$(command {' '.join(quoted(word.text) for word in given)})"
        return self._run(words, on_stderr, self._file.parent, self._env)

    def _typed(self, given: list[Word]) -> Data:
        kind, text = _words(given, 2, "as TYPE TEXT")
        if self._run is None and "$(command " in text:  # it has not been run
            return f"$(as {kind} {as_word(text)})"
        try:
            return as_type(kind, text)
        except ValueError as error:
            raise SubstitutionError(f"$(as {kind} ...): {error}") from None

    def _chosen(self, given: list[Word]) -> str:
        condition, yes, *no = _words(given, (2, 3), "if CONDITION A B")
        return yes if _is_true(condition) else "".join(no)


def _default(given: list[Word]) -> Data:
    """Return the default after a name: text in quotes, or what is parsed as YAML where a value is needed."""
    text = _joined(given)
    return text if given[0].is_quoted else Written(text)


def _joined(given: Sequence[Word]) -> str:
    """Join words to a text without quotes."""
    return " ".join(word.text for word in given)


def _text(value: Data) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return str(value)


def _found(folder: Path | None, package: str, written: str, root: Path) -> str:
    if folder is None:
        why = why_no_package(package, find_workspace(root)) or "no package of that name is installed"
        hint = "; it is on PyPI: pip install xacro" if package == "xacro" else ""
        raise SubstitutionError(f"$({written}): {why}{hint}")
    return str(folder)


_TRUTHS = {"yes": "true", "y": "true", "on": "true", "no": "false", "n": "false", "off": "false"}
"""Words for truth values that conditions do not accept, with those that they do."""


def truth(value: object, file: str) -> bool:
    """Return the truth value of a condition in a file; hints for launch files in Python have other comparisons.

    Raises:
        SubstitutionError: The value is neither true nor false.
    """
    words, word = {"true": True, "1": True, "false": False, "0": False}, str(value).strip().lower()
    if isinstance(value, (bool, int, str)) and word in words:
        return words[word]
    if re.fullmatch(r"(true|false) *== *(true|false)", word):
        alone = "IfCondition(LaunchConfiguration(NAME))" if file.endswith(".py") else "if: $(var NAME)"
        raise SubstitutionError(f"a comparison is not made here; the argument alone is the condition: {alone}")
    meant = _TRUTHS.get(word)
    compare = "EqualsSubstitution(..., 'text')" if file.endswith(".py") else "$(eval NAME == 'text')"
    way = f"write {meant!r}" if meant is not None else f"compare with {compare}"
    if meant is None and isinstance(value, str) and value.isidentifier():
        way = f"to use the argument of that name write {as_argument(value, file)}; else {way}"
    raise SubstitutionError(f"expected true or false, got {value!r}; {way}")


def _is_true(text: str) -> bool:
    """Return the truth value of a text by YAML 1.1, which also has `on` and `no`."""
    try:
        return bool(as_type("bool", text))
    except ValueError as error:
        raise SubstitutionError(str(error)) from None


def _truths(texts: list[str]) -> list[bool]:
    """Return the truth values of all texts, so that an invalid one is reported even if others decide the result."""
    return [_is_true(text) for text in texts]


def _is_equal(left: str, right: str) -> bool:
    """Return whether two texts are equal: as truth values or numbers, if both are."""
    words = {"true": True, "1": True, "false": False, "0": False}
    truths = [words.get(text.lower()) for text in (left, right)]
    if None not in truths:
        return truths[0] is truths[1]
    try:
        # `isclose`, as launch's EqualsSubstitution has it.
        return math.isclose(float(left), float(right))
    except ValueError:
        return left == right


def _words(given: Sequence[Word], counts: int | Sequence[int], form: str) -> list[str]:
    """Return the texts of words, whose number must be one of `counts`."""
    allowed = (counts,) if isinstance(counts, int) else counts
    if len(given) not in allowed:
        raise SubstitutionError(f"write $({form})")
    return [word.text for word in given]


_FUNCTIONS: dict[str, Callable[[Substitutions, list[Word]], Data]] = {
    "var": Substitutions._var,
    "env": Substitutions._environment,
    "optenv": Substitutions._optional_environment,
    "dirname": Substitutions._dirname,
    "filename": Substitutions._filename,
    "log_dir": Substitutions._log_folder,
    "launch_log_dir": Substitutions._log_folder,
    "param": Substitutions._param,
    "find-pkg-share": Substitutions._share,
    "find-pkg-prefix": Substitutions._prefix,
    "exec-in-pkg": Substitutions._program,
    "find-exec": Substitutions._executable,
    "file-content": Substitutions._content,
    "substituted": Substitutions._substituted,
    "anon": Substitutions._anonymous,
    "eval": Substitutions._eval,
    "command": Substitutions._command,
    "if": Substitutions._chosen,
    "as": Substitutions._typed,
    "not": lambda _, given: not _is_true(_joined(given)),
    "and": lambda _, given: all(_truths(_words(given, 2, "and A B"))),
    "or": lambda _, given: any(_truths(_words(given, 2, "or A B"))),
    "all": lambda _, given: all(_truths([word.text for word in given])),
    "any": lambda _, given: any(_truths([word.text for word in given])),
    "equals": lambda _, given: _is_equal(*_words(given, 2, "equals A B")),
    "not-equals": lambda _, given: not _is_equal(*_words(given, 2, "not-equals A B")),
}
"""Substitutions by name, each a function of the words after it."""
