"""`graphflow`, and `gf` for short: the verbs, and how a command ends."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from io import TextIOWrapper
from typing import NoReturn

import click

from graphflow import __version__
from graphflow.cli import exits, output
from graphflow.cli.net_options import apply_reach, reach_options
from graphflow.cli.numbers import plain_words
from graphflow.cli.other_words import option_answer
from graphflow.cli.placing import OF_GRAPHFLOW, before_the_verb
from graphflow.cli.variables import misspelt
from graphflow.cli.verbs import HABITS, NOT_NEEDED, Verbs
from graphflow.errors import GraphflowError, SupervisorError, UsageFault
from graphflow.names import nearest
from graphflow.typographic import option as meant_option
from graphflow.wire.profile import PROFILES, VARIABLE, wire_profile

_VERBS = {
    "init": ("projects.init", "Write a starter project."),
    "up": ("graphs.graphs", "Start a graph from its file."),
    "down": ("graphs.graphs", "Stop a running graph."),
    "attach": ("graphs.console", "Open the console on a running graph."),
    "ls": ("graphs.console", "List running graphs."),
    "ps": ("graphs.graphs", "List the nodes of running graphs."),
    "start": ("graphs.nodes", "Start nodes that have ended."),
    "restart": ("graphs.nodes", "Restart nodes, whether they run or have ended."),
    "stop": ("graphs.nodes", "Stop nodes."),
    "status": ("graphs.nodes", "Show a node's state, how it last ended, and the end of its log."),
    "wait": ("graphs.nodes", "Wait until nodes are ready."),
    "logs": ("graphs.graphs", "Show the logs of a graph's nodes."),
    "plan": ("graphs.files", "Show exactly what a graph file would run."),
    "check": ("graphs.files", "Report every mistake in a graph file."),
    "explain": ("graphs.files", "Explain how a name in a graph is resolved."),
    "schema": ("graphs.files", "Print the JSON Schema of graph files."),
    "launch": ("ros.launch", "Start a launch file as `up` does, or convert it."),
    "run": ("ros.run", "Run one node."),
    "rclpy": ("ros.rclpy", "Make rclpy importable from plain `python`, or undo that."),
    "ws": ("ros.ws", "Show the packages of a ROS 2 workspace, which need not be built."),
    "demo": ("graphs.demo", "Walk through an example, step by step."),
    "graph": ("graphs.graph", "Draw the running nodes and topics."),
    "snapshot": ("graphs.snapshot", "Save turtlesim's drawing as an SVG picture."),
    "view": ("graphs.view", "Serve the running graph to Foxglove, Lichtblick and PlotJuggler."),
    "top": ("graphs.top", "Show CPU, memory and message rates of running processes."),
    "router": ("graphs.router", "Run a Zenoh router as the rendezvous of this machine."),
    "node": ("ros.node", "List and describe nodes."),
    "topic": ("ros.topic", "List, describe, show and publish to topics."),
    "service": ("ros.service", "List and call services."),
    "action": ("ros.action", "List actions and send goals to them."),
    "param": ("ros.param", "List, get, set, describe, dump and load parameters."),
    "bag": ("ros.bag", "Record, play, inspect and convert bags."),
    "pkg": ("ros.pkg", "List packages and their contents, or create one."),
    "component": ("ros.component", "Load nodes into running processes, and unload them."),
    "lifecycle": ("ros.lifecycle", "Show and change the states of lifecycle nodes."),
    "tf": ("ros.tf", "Show transforms between frames; publish static ones."),
    "map": ("ros.map", "Show and save maps."),
    "waits": ("graphs.waits", "Show which handlers hold slots, what they wait for, and where."),
    "groups": ("graphs.waits", "Show a node's groups, or change them while it runs."),
    "doctor": ("ros.doctor", "Check the running graph for problems."),
    "console": ("graphs.console", "Open the console on a running graph, here or in a browser."),
    "completion": ("completion", "Set up TAB completion of verbs, live names, types and messages."),
    "interface": ("ros.interface", "Show message, service and action types."),
}
"""Verb -> its module and its line in the help; the module is imported only when the verb is used."""


ALIKE = 0.55
"""Similarity to an unknown option from which another is suggested."""
_ALIASES = {"wtf": "doctor"}
"""Second names of verbs, as in ROS 2."""
_OTHER_WORDS = {"kill": "stop", "interfaces": "interface"}
"""Verbs of other tools, and ours of the same meaning."""


def _runs(words: Sequence[str]) -> bool:
    """Whether words are a package with an executable: `run` is forgotten."""
    from pathlib import Path

    from graphflow.workspace.executables import EXECUTABLES
    from graphflow.workspace.packages import find_workspace

    if len(words) < 2 or tuple(words[:2]) in EXECUTABLES:
        return len(words) > 1
    package = find_workspace(Path.cwd()).packages.get(words[0])
    return package is not None and words[1] in package.executables


class _Verbs(Verbs):
    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(_VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        cmd_name = _ALIASES.get(cmd_name, cmd_name)
        if cmd_name not in _VERBS:
            return None
        module = import_module(f"graphflow.cli.{_VERBS[cmd_name][0]}")
        command: click.Command = getattr(module, cmd_name.replace("-", "_"))
        return command

    def order_hint(self, ctx: click.Context, words: Sequence[str]) -> str:
        word, *rest = words
        if word == "ros2":
            return f"leave out ros2: graphflow {' '.join(rest)}".rstrip()
        group = self.get_command(ctx, rest[0]) if rest else None
        if isinstance(group, click.Group) and group.get_command(ctx, word) is not None:
            return f"no such command {word!r}; did you mean: graphflow {' '.join([rest[0], word, *rest[1:]])}"
        if _runs(words):
            return f"no such command {word!r}; did you mean: graphflow run {' '.join(words)}"
        from graphflow.workspace.executables import with_graphflow

        package = next((package for package, name in with_graphflow() if name == word), None)
        way = f"graphflow run {package} {' '.join(words)}"
        return f"no such command {word!r}; did you mean: {way}" if package is not None else ""

    def unknown(self, ctx: click.Context, word: str) -> str:
        meant = (
            ""
            if word in NOT_NEEDED or word in HABITS
            else _OTHER_WORDS.get(nearest(word, [*_OTHER_WORDS, *_VERBS]) or "")
        )
        return f"no such command {word!r}; did you mean {meant!r}?" if meant else super().unknown(ctx, word)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(verb, text) for verb, (_, text) in _VERBS.items()])


@click.group(cls=_Verbs, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="graphflow")
@click.option("--domain", type=click.IntRange(0), help="Domain id; else GRAPHFLOW_DOMAIN, ROS_DOMAIN_ID, or 0.")
@click.option(
    "--wire",
    type=click.Choice(PROFILES),
    help="ROS 2 distribution to match; else GRAPHFLOW_WIRE, or jazzy.",
)
@reach_options
@click.pass_context
def cli(ctx: click.Context, /, domain: int | None, wire: str | None, connect: tuple[str, ...], net: str | None) -> None:
    """Node graphs for robots, with ROS 2's concepts and wire protocol.

    \b
    Start with:   graphflow up turtlesim
    Then try:     graphflow topic list
    """  # noqa: D301 - click wants the character
    ctx.obj = dict(os.environ)
    for fault in misspelt(os.environ):
        output.talk(f"note: {fault}")
    if domain is not None:
        os.environ["GRAPHFLOW_DOMAIN"] = str(domain)
    if wire is not None:
        os.environ[VARIABLE] = wire
    apply_reach(connect, net)
    try:
        wire_profile()
    except GraphflowError as error:  # report a misspelt variable before doing anything
        raise UsageFault(str(error)) from None


def _open_standard_streams() -> None:
    """Open the null device for each closed standard stream, whose number the next opened file would get."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest free number, which is `number`
        if getattr(sys, name) is None:
            raw = open(number, "wb" if number else "rb", closefd=False)  # noqa: SIM115 - open until the process ends
            setattr(sys, name, (output.Closed if number == 1 else TextIOWrapper)(raw, encoding="utf-8"))


def _forget_output() -> None:
    """Redirect standard output to the null device, so that the flush at exit cannot fail again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def main(args: Sequence[str] | None = None) -> NoReturn:
    """Run a command and end the process with its exit code."""
    sys.exit(_main(args))


def _refuse_pasted(words: Sequence[str]) -> None:
    """Refuse options that begin with a typographic dash, as copied from slides and web pages.

    Raises:
        UsageFault: One does; the text has the option as it should be.
    """
    pasted = {word: meant_option(word) for word in words}
    if not any(pasted.values()):
        return
    command: click.Command = cli
    context = click.Context(cli)
    known = {"--help", "-h"}
    for word in (*words, ""):
        known |= {name for param in command.params for name in (*param.opts, *param.secondary_opts)}
        if isinstance(command, click.Group) and (inner := command.get_command(context, word)) is not None:
            command, context = inner, click.Context(inner, parent=context, info_name=word)
    for word, option in pasted.items():
        if option.partition("=")[0] in known:
            raise UsageFault(f"{word!r} begins with a typographic dash, not a hyphen; write {option}")


def _invoked(args: Sequence[str]) -> object:
    """Run a command and return its result. Click's own `main` would report a closed pipe as a failure."""
    name = "gf" if os.path.basename(sys.argv[0]) == "gf" else "graphflow"
    _refuse_pasted(args)
    try:
        with cli.make_context(name, list(args)) as context:  # also parses, so it raises usage errors, too
            return cli.invoke(context)
    except click.exceptions.Exit as end:
        return end.exit_code


def _report_starts(reported: str) -> None:
    """Print which graph is being started, unless the error already printed mentions it."""
    from graphflow.supervisor.starts import being_started

    with suppress(SupervisorError):  # there is no run directory, so nothing is being started
        starts = being_started()
        if starts not in reported:
            output.talk(starts)


def _improved(error: click.UsageError) -> click.UsageError:
    """Return a usage error with only suggestions that are similar, and with plain words for invalid numbers."""
    if isinstance(error, click.NoSuchOption) and error.ctx is not None:
        if hint := option_answer(error.ctx.command_path.partition(" ")[2], error.option_name):
            return click.UsageError(f"No such option {error.option_name!r}; {hint}", error.ctx)
        known = {name for param in error.ctx.command.params for name in param.opts}
        if (other := error.option_name.swapcase()) in known or (other := error.option_name.lower()) in known:
            return click.UsageError(f"{error.message} Did you mean {other!r}?", error.ctx)
    if isinstance(error, click.NoSuchOption) and error.possibilities:
        word = error.option_name.lstrip("-")  # the dashes would make all options similar
        alike = [known for known in error.possibilities if nearest(word, [known.lstrip("-")], cutoff=ALIKE)]
        return click.NoSuchOption(error.option_name, error.message, alike, error.ctx)
    param = error.param if isinstance(error, click.BadParameter) else None
    about = f"{param.help} {' '.join(param.opts)}" if isinstance(param, click.Option) else ""
    text = plain_words(error.message, about)
    if text == error.message:
        return error
    return click.UsageError(error.format_message().replace(error.message, text), error.ctx)


def _main(args: Sequence[str] | None) -> int:
    _open_standard_streams()
    words = sys.argv[1:] if args is None else args
    try:
        result = _invoked(words)
    except click.UsageError as error:
        if isinstance(error, click.NoSuchOption) and error.option_name in OF_GRAPHFLOW:
            error = click.UsageError(before_the_verb(error.option_name, words), error.ctx)
        _improved(error).show()
        return exits.USAGE
    except click.ClickException as error:
        error.show()
        return exits.FAILED
    except (KeyboardInterrupt, click.Abort):
        return exits.OK
    except BrokenPipeError:
        _forget_output()  # the reader, such as `head`, has closed the pipe
        return exits.OK
    except GraphflowError as error:
        output.error(str(error))
        if (code := exits.exit_code(error)) == exits.NOT_RUNNING:
            _report_starts(str(error))
        return code
    except OSError as error:  # a full disk, a file that has gone: the system's own text says it best
        _forget_output()
        place = f"{error.filename}: " if error.filename else "output: " if error.errno == errno.ENOSPC else ""
        output.error(f"{place}{error.strerror or error}")
        return exits.FAILED
    return result if isinstance(result, int) else exits.OK


if __name__ == "__main__":
    main()
