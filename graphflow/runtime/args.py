"""Parsing of a node's ROS 2 arguments: `--ros-args -r from:=to -p name:=value --`.

Source: rcl arguments; `ros2 run ... --help` and the "Passing ROS arguments" guide.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from graphflow.errors import GraphFileError, GraphflowError, InvalidName
from graphflow.interface import Interface
from graphflow.names import Remap, Resolver, did_you_mean, nearest
from graphflow.typographic import DASHES
from graphflow.typographic import option as meant_option

logger = logging.getLogger("graphflow")

_RULED = ("-r", "--remap", "-p", "--param")
_VALUED = (*_RULED, "--params-file", "--log-level")
_EXAMPLES = {
    **dict.fromkeys(("-r", "--remap"), "pose:=/turtle1/pose"),
    **dict.fromkeys(("-p", "--param"), "rate:=2.0"),
    "--params-file": "params.yaml",
}
_LEFT_OUT = ("--log-config-file", "--log-file-name", "-e", "--enclave")
"""Options with a value that graphflow ignores: the supervisor owns the logs, and there are no security enclaves."""
_FLAGS = {
    f"--{verb}-{what}-logs": verb == "enable"
    for verb in ("enable", "disable")
    for what in ("rosout", "stdout", "external-lib")
}
_DASHES = ("-", *DASHES)
_OPTION = re.compile(f"[{''.join(_DASHES)}]+[A-Za-z]")
"""The beginning of an option, unlike that of a negative number."""
_OPTIONS = (*_VALUED, *_LEFT_OUT, *_FLAGS, "--ros-args", "--")


@dataclass
class RosArgs:
    """The parsed ROS 2 arguments of one command line."""

    remaps: list[Remap] = field(default_factory=list)
    params: list[tuple[str | None, str, object, str]] = field(default_factory=list)
    """(node or None for all, parameter, value, source of the value)."""
    params_files: list[str] = field(default_factory=list)
    log_level: str = "info"
    log_levels: dict[str, str] = field(default_factory=dict)
    """Levels of single loggers, by logger name."""
    has_rosout: bool = True
    """Whether log records are published on /rosout."""
    has_stdout: bool = True
    """Whether log records are printed."""
    rest: list[str] = field(default_factory=list)
    """Arguments that are not ROS 2's."""
    unknown: list[str] = field(default_factory=list)
    """Unrecognized arguments after `--ros-args`, if the caller allows them."""

    def params_for(self, interface: Interface) -> dict[str, tuple[object, str]]:
        """Return the parameter values for a node of a class: name to (value, source of the value).

        Raises:
            GraphFileError: A parameter file is invalid, or has no section for this node.
        """
        full_name = Resolver(interface.node_name, "/", self.remaps).full_name
        if self.params_files:
            from graphflow.graph import params_file  # and with it PyYAML, which most processes never need
        found: dict[str, tuple[object, str]] = {}
        for file in self.params_files:
            sections = params_file.read(Path(file), file)
            if not any(s.fits(full_name) for s in sections):
                raise GraphFileError(params_file.strays(sections, [full_name]))
            for name, setting in params_file.params_for(sections, full_name).items():
                if not setting.is_optional or interface.param(name) is not None:
                    found[name] = (setting.value, str(setting.place))
                else:
                    logger.warning("%s: %s has no parameter %r; it is ignored", setting.place, full_name, name)
        names = (None, interface.node_name, full_name.rpartition("/")[2])
        return found | {p: (v, source) for node, p, v, source in self.params if node in names}


def parse_ros_args(arguments: Sequence[str], *, refuses_unknown: bool = True) -> RosArgs:
    """Parse a node's arguments. A bare `from:=to`, which ROS 2 silently ignores, counts as a remap.

    Args:
        refuses_unknown: Whether an unrecognized argument is an error; if not, a bare `from:=to` is unrecognized too.

    Raises:
        GraphflowError: A remap rule or an option is invalid.
    """
    result = RosArgs()
    todo = list(arguments)
    in_ros = False
    while todo:
        argument = todo.pop(0)
        if argument == "--ros-args":
            in_ros = True
        elif argument == "--" and in_ros:
            in_ros = False
        elif argument in _FLAGS and in_ros:
            _flag(result, argument)
        elif argument in _VALUED or (in_ros and argument in _LEFT_OUT):
            if not todo or todo[0] in _OPTIONS:
                raise GraphflowError(f"{argument} needs a value after it, such as {_EXAMPLES.get(argument, 'info')}")
            _option(result, argument, todo.pop(0))
        elif ":=" in argument and not argument.startswith("-") and refuses_unknown:
            _remap(result, argument)
        elif in_ros and not refuses_unknown:
            result.unknown.append(argument)
        elif in_ros or _slip(argument):
            raise GraphflowError(f"{argument!r} is not a ROS argument{unrecognized(argument, arguments)}")
        else:
            result.rest.append(argument)
    return result


def unrecognized(argument: str, arguments: Sequence[str]) -> str:
    """Return a hint on an argument that ROS 2 does not know, as the end of a sentence; "" if there is none.

    Args:
        arguments: The whole command line.
    """
    return cut_off(argument, arguments) or _with_value(argument, arguments) or meant(argument)


def _with_value(argument: str, arguments: Sequence[str]) -> str:
    """Return a hint on an option that is misspelt, from the value after it: `--params rate:=2`."""
    [value] = arguments[list(arguments).index(argument) + 1 :][:1] or [""]
    near = nearest(argument, _VALUED) if argument.startswith("--") else None
    if near in ("--param", "--params-file") and ":=" in value:
        return f"; write -p {value}"
    if near in ("--param", "--params-file") and value.endswith((".yaml", ".yml")):
        return f"; write --params-file {value}"
    return ""


def meant(argument: str) -> str:
    """Return a hint on how to write an argument that ROS 2 does not know, as the end of a sentence; "" if unknown."""
    if ":=" in argument and not argument.startswith(_DASHES):
        match, _, replacement = argument.partition(":=")
        key = nearest(match, ("__ns", "__node")) if match.startswith("__") else None
        is_private = key is None and re.match("_[a-z]", match) is not None  # ROS 1's syntax for a parameter
        option = "-p" if is_private or (key is None and is_number_or_truth(replacement)) else "-r"
        return f"; write --ros-args {option} {key or match[is_private:]}:={replacement}"
    option, equals, value = argument.partition("=")
    if equals and option in _VALUED:
        return f"; write {option} {value}, without ="
    if option := _slip(argument):
        return f"; write {option}"
    return did_you_mean(argument, _OPTIONS)


def cut_off(argument: str, arguments: Sequence[str]) -> str:
    """Return a hint about an argument that a space split from the value before it; "" for any other.

    Args:
        arguments: The whole command line.
    """
    place = list(arguments).index(argument)
    option, before = arguments[place - 2 : place] if place > 1 else ("", "")
    is_cut = option in _VALUED and ":=" in before and not _OPTION.match(argument)
    return f"; quote a value that contains a space: {option} '{before} {argument}'" if is_cut else ""


def is_number_or_truth(text: str) -> bool:
    """Whether a text is a number or a boolean, neither of which can be a name."""
    return text.lower() in ("true", "false") or text.lstrip("+-").replace(".", "", 1).isdecimal()


_WITH_WORDS = ("--ros-args ", "-p ", "-r ", "--param ", "--remap ", "--params-file ")
"""Beginnings of arguments that are several words in one, as launch files may write them."""
_EQUALS = re.compile(r"([\w/~]+)=(\S+)")
"""A rule with the wrong sign."""


def missed(arguments: Sequence[str]) -> str:
    """Return a sentence about arguments outside `--ros-args` that seem meant for ROS 2; "" if there are none.

    ROS 2 silently passes them to the program. A program may have options of its own, so only those that are
    unlikely to belong to it count as mistakes.
    """
    in_ros = False
    for place, argument in enumerate(arguments):
        if argument == "--ros-args":
            in_ros = True
        elif argument == "--":
            in_ros = False
        elif not in_ros and argument.startswith(_WITH_WORDS):
            return f"{argument!r} is one word to ROS; write each apart: {argument.split()}"
        elif not in_ros and (option := _slip(argument)):
            rest = " ".join(arguments[place + 1 :])
            way = option if option == "--ros-args" else f"--ros-args {option}"
            return f"{argument!r} means nothing to ROS, nor does the rest{f' ({rest})' if rest else ''}; write {way}"
        elif not in_ros and argument == "--params-file" and _is_yaml(after := next(iter(arguments[place + 1 :]), "")):
            return f"{argument!r} means nothing to ROS before --ros-args; write --ros-args {argument} {after}"
        elif not in_ros and ":=" in argument:
            before = arguments[place - 1] if place else ""
            is_whole = before in _VALUED and not argument.startswith("___")
            way = f"; write --ros-args {before} {argument}" if is_whole else meant(argument)
            return f"{argument!r} means nothing to ROS before --ros-args{way}"
        elif (
            not in_ros and argument in _RULED and (rule := _EQUALS.fullmatch("".join(arguments[place + 1 : place + 2])))
        ):
            return f"if {rule[0]!r} is for ROS, write --ros-args {argument} {rule[1]}:={rule[2]}"
    return ""


def _is_yaml(file: str) -> bool:
    return file.endswith((".yaml", ".yml"))


def _slip(argument: str) -> str:
    """Return the ROS 2 option that an argument almost spells, such as `-ros-args`; "" if there is none."""
    if (pasted := meant_option(argument)) in _OPTIONS:
        return pasted
    bare = argument.lstrip("".join(_DASHES))
    if argument in ("--ros-args", "--params-file", bare):
        return ""
    return "--params-file" if bare == "params-file" else nearest(f"--{bare}", ["--ros-args"], cutoff=0.85) or ""


def _flag(result: RosArgs, flag: str) -> None:
    if "rosout" in flag:
        result.has_rosout = _FLAGS[flag]
    elif "stdout" in flag:
        result.has_stdout = _FLAGS[flag]


def _option(result: RosArgs, option: str, value: str) -> None:
    if option in ("-r", "--remap"):
        _remap(result, value)
    elif option == "--log-level":
        name, arrow, argument = value.partition(":=")
        if arrow:
            result.log_levels[name] = argument
        else:
            result.log_level = value
    elif option == "--params-file":
        result.params_files.append(value)
    elif option in _LEFT_OUT:
        logger.warning("%s means nothing to graphflow and is ignored", option)
    else:
        target, arrow, text = value.partition(":=")
        if not arrow or not target:
            slip = re.fullmatch(r"([A-Za-z_][\w.]*)\s*[=:]\s*(\S+)", value)
            way = f"{slip[1]}:={slip[2]}" if slip is not None else "name:=value, for example rate:=2.0"
            raise GraphflowError(f"-p {value!r}: write {way}")
        if not text:
            raise GraphflowError(f"-p {value!r}: the value is missing; write it after :=, without a space")
        if re.search(r"\s[\w.]+:=", text):
            raise GraphflowError(f"-p {value!r}: write one -p each: {' '.join(f'-p {one}' for one in value.split())}")
        node, colon, name = target.rpartition(":")
        result.params.append((node if colon else None, name, _value(text, value), "command line"))


def _value(text: str, rule: str) -> object:
    from graphflow.markup.source import parse_value

    try:
        return parse_value(text)
    except GraphflowError:
        if any(text.count(begin) > text.count(end) for begin, end in ("[]", "{}")):
            way = "put quotes around a rule with blanks in it, as in -p 'places:=[1.0, 2.0]'"
            raise GraphflowError(f"-p {rule!r}: the bracket is not closed; {way}") from None
        raise


def _remap(result: RosArgs, text: str) -> None:
    try:
        result.remaps.append(Remap.parse(text, "command line"))
    except InvalidName as error:
        raise GraphflowError(str(error)) from None
