"""`graphflow run`: run one node, or a program written for rclpy."""

from __future__ import annotations

import os
import shlex
import signal
import sys
from inspect import getfile
from pathlib import Path
from typing import NoReturn

import click

from graphflow.cli import output
from graphflow.cli.placing import before_the_verb, option_after_verb
from graphflow.errors import GraphflowError, RunsWhenImported, UsageFault
from graphflow.reading import found_text

_VERBS = {("rmw_zenoh_cpp", "rmw_zenohd"): "router", ("rqt_graph", "rqt_graph"): "graph"}
"""Programs of ROS 2 that are verbs of graphflow."""


@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.option("--prefix", help="Command under which to run the node, such as 'gdb -ex run --args' or 'nice -n 10'.")
@click.argument("what", metavar="MODULE:CLASS|FILE.py|NAME")
@click.argument("words", nargs=-1, type=click.UNPROCESSED)
def run(prefix: str | None, what: str, words: tuple[str, ...]) -> None:
    """Run one node: `graphflow run nodes.talker:Talker --ros-args -r chatter:=news -p rate:=2.0`.

    A file (nodes/talker.py) or module (nodes.talker) with one node class will do, and so will the name of a node that
    comes with graphflow (turtlesim). Other words are passed to the program in sys.argv; those that nothing reads are
    refused.

    Programs written for rclpy run unchanged and without building: a file, or a package of a ROS 2 workspace and its
    executable, as listed in its setup.py, setup.cfg or CMakeLists.txt.

    \b
    -r from:=to     remap a name; __node:=NAME and __ns:=/NAMESPACE rename the node
    -p name:=value  set a parameter
    """  # noqa: D301 - click wants the character
    from graphflow.cli.projects.node_lookup import find_class
    from graphflow.domain import domain_id
    from graphflow.introspect.graph_view import refuse_taken_names
    from graphflow.names import Resolver
    from graphflow.rclpy.programs import find_program
    from graphflow.runtime.args import cut_off, parse_ros_args
    from graphflow.runtime.mistakes.unread import unread
    from graphflow.runtime.run import run as run_node

    _refuse(what)
    if (option := option_after_verb(words)) is not None and not _mentions(what, option):
        placed = before_the_verb(option, ["run", what, *words])
        output.talk(f"note: {option} after the node is passed to its program; graphflow's {placed}")
    verb = _VERBS.get((what, words[0] if words else ""))
    command = [verb, *words[1:]] if verb else ["run", what, *words]
    if prefix or verb:
        try:
            before = shlex.split(prefix or "")
        except ValueError as error:
            raise UsageFault(f"--prefix {prefix!r}: {error}") from None
        _become([*before, sys.executable, "-m", "graphflow", *command])
    program = find_program(what, words, Path.cwd())
    if program is not None:
        if hasattr(signal, "pthread_sigmask"):
            signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))  # an interpreter cannot handle it while starting
        # With -m alone, a file of the working directory, such as queue.py, would hide a module of Python.
        _become([sys.executable, "-P", "-m", "graphflow.rclpy", *command[1:]])
    try:
        cls, rest = find_class(what, words)
    except RunsWhenImported:
        _become([sys.executable, what, *(["--ros-args", *words] if words and "--ros-args" not in words else words)])
    try:
        ros = parse_ros_args(rest)
    except GraphflowError as error:
        raise UsageFault(str(error)) from None
    if text := unread(ros.rest, [cls], is_own_program=False):
        cut = cut_off(ros.rest[0], rest)
        raise UsageFault(f"nothing reads {ros.rest[0]!r}{cut}" if cut else text)
    sys.argv = [getfile(cls), *ros.rest]
    names = Resolver(cls.interface().node_name, "/", ros.remaps)
    way = "start this one with -r __ns:=/NAME, or -r __node:=NAME"
    refuse_taken_names([names.full_name], domain_id(), hint=way)
    run_node(cls, args=rest)


def _refuse(what: str) -> None:
    """Refuse an option, and a launch file, whose run would only define its description.

    Raises:
        UsageFault: It is one of them; the text has what to write.
    """
    if what.startswith("-"):
        raise UsageFault(f"run has no option {what!r}; the node's options come after its name")
    source = found_text(Path(what)) if what.endswith(".py") and Path(what).is_file() else ""
    if "def generate_launch_description" in source and "__main__" not in source:
        raise UsageFault(f"{what} is a launch file; run it with: graphflow launch {what}")


def _mentions(what: str, option: str) -> bool:
    """Whether the file to run mentions an option of that name, which is then its own."""
    try:
        return what.endswith(".py") and option in found_text(Path(what), "replace")
    except OSError:
        return False


def _become(command: list[str]) -> NoReturn:
    """Replace this process by another program.

    Raises:
        UsageFault: There is none of that name.
    """
    try:
        os.execvp(command[0], command)
    except FileNotFoundError:
        raise UsageFault(f"--prefix: there is no program {command[0]!r} on the PATH") from None
