"""Groups of verbs that answer an unknown word: a misspelling, or a verb of `ros2` that is not needed here.

Verbs that inspect a graph accept, and ignore, the options by which `ros2` finds its daemon: graphflow has none.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import click

from graphflow.cli.other_words import answer
from graphflow.names import did_you_mean, nearest

_BUILT_IN = "its verbs are built in; graphflow pkg executables lists the programs of packages"
NOT_NEEDED = {
    "daemon": "none is needed: there is no daemon",
    "multicast": "none is needed: a graph stays on this machine unless `--net` or `--connect` says otherwise",
    **dict.fromkeys(("extensions", "extension_points", "extension-points"), _BUILT_IN),
    "security": "a graph is reachable from this machine only unless `--net` says otherwise",
}
"""Verbs of `ros2` that graphflow does not need: the reason, or what to use instead."""
_NOT_BUILT = "nothing has to be built or sourced: what you edit is what runs; graphflow ws shows the packages"
HABITS = {
    **dict.fromkeys(("colcon", "build", "source", "catkin", "catkin_make"), _NOT_BUILT),
    "rosdep": "Python packages are installed by pip; ROS 2 packages are in the workspace, as source",
    "install": "nothing has to be installed for a package to run; graphflow ws shows the packages",
}
"""Commands for a ROS 2 workspace that are not needed here, and why."""


OF_ONE = {
    "node list": "node info",
    "topic list": "topic info",
    "service list": "service info",
    "action list": "action info",
    "interface list": "interface package",
    "interface packages": "interface package",
    "pkg list": "pkg executables",
    "lifecycle nodes": "lifecycle get",
    "ps": "status",
    "waits": "groups",
}
"""Verbs that list everything and take no name, and the verb that takes one."""


class Verb(click.Command):
    """A verb that answers surplus words: a verb that lists everything names the one that takes a name."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        path = ctx.command_path.partition(" ")[2]
        # Click raises its own error for surplus words unless they are allowed; they are refused below.
        takes_more, ctx.allow_extra_args = ctx.allow_extra_args, True
        left = super().parse_args(ctx, list(args))
        if left and (flag := flag_before(self, left[0], args)):
            ctx.fail(f"{flag} takes no value; leave out {left[0]}")
        if left and (operator := next((word for word in args if word in _OF_SHELLS), "")):
            ctx.fail(f"{operator} is for a shell, and no shell reads this line: run it in a terminal")
        if left and path in OF_ONE:
            one = "interface show" if path.startswith("interface") and "/" in left[0] else OF_ONE[path]
            if path.startswith("interface") and left[0][:1].isupper():  # a type, and no package
                one, left[0] = "interface show", f"PACKAGE/msg/{left[0]}"
            ctx.fail(f"{path} takes no name; for one: graphflow {one} {left[0]}")
        if left and not takes_more and not ctx.resilient_parsing:
            ctx.fail(self.one_too_many(ctx, left))
        return left

    def one_too_many(self, ctx: click.Context, left: Sequence[str]) -> str:
        """Return the error text for surplus words."""
        return f"Got unexpected extra argument{'s' if len(left) > 1 else ''} ({' '.join(left)})"


_OF_SHELLS = ("|", ">", ">>", "<", "&", "&&", "||", ";", "2>&1")
"""Operators that no shell leaves in the words of a command; the console's prompt passes them on."""
_A_VALUE = re.compile(r"[-+]?[\d.]+\w{0,2}|true|false|yes|no|on|off", re.IGNORECASE)
"""A word that looks like an option's value rather than a name."""


def flag_before(command: click.Command, word: str, args: Sequence[str]) -> str:
    """Return the flag directly before `word` if that looks like a value; empty otherwise."""
    before = args[list(args).index(word) - 1] if word in args[1:] else ""
    flags = {
        name for param in command.params if isinstance(param, click.Option) and param.is_flag for name in param.opts
    }
    return before if before in flags and _A_VALUE.fullmatch(word) else ""


class Verbs(click.Group):
    """Verbs, or the verbs of one verb."""

    command_class = Verb

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, list(args))
        except click.NoSuchOption as error:
            word = next((word for word in args if word.startswith(error.option_name)), error.option_name)
            near = nearest(word.lstrip("-"), self.list_commands(ctx), cutoff=0.8)
            if near is None:
                raise
            raise click.UsageError(f"no such option {word!r}; did you mean {near!r}?", ctx) from None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and not args[0].startswith("-") and self.get_command(ctx, args[0]) is None:
            path = ctx.command_path.partition(" ")[2]
            raise click.UsageError(self.order_hint(ctx, args) or answer(path, args) or self.unknown(ctx, args[0]), ctx)
        return super().resolve_command(ctx, args)

    def order_hint(self, ctx: click.Context, words: Sequence[str]) -> str:
        """Return the error text for a command whose words are in the wrong order; empty if they are not."""
        return ""

    def unknown(self, ctx: click.Context, word: str) -> str:
        """Return the error text for a word that is not a verb."""
        path = word if ctx.parent is None else f"{ctx.info_name} {word}"
        if path in NOT_NEEDED:
            return f"graphflow has no {path!r}: {NOT_NEEDED[path]}".replace("`", "")
        if ctx.parent is None and word in HABITS:
            return f"no such command {word!r}: {HABITS[word]}"
        hint = did_you_mean(word, self.list_commands(ctx))
        return f"no such command {word!r}{hint or f'; graphflow {path.removesuffix(word)}--help lists all'}"


_STAYING = {"echo", "hz", "bw", "delay", "plot", "pub", "call", "send_goal"}
"""Verbs that run for a while, for which simulated time would matter: they must not ignore `--use-sim-time`."""


class GraphVerbs(Verbs):
    """Verbs that inspect a graph."""

    def add_command(self, cmd: click.Command, name: str | None = None) -> None:
        known = {word for param in cmd.params for word in param.opts}
        options = [
            click.Option(["--no-daemon"], is_flag=True, hidden=True, expose_value=False),
            click.Option(["--spin-time"], type=float, hidden=True, expose_value=False),
        ]
        if name not in _STAYING and cmd.name not in _STAYING:
            options.append(click.Option(["-s", "--use-sim-time"], is_flag=True, hidden=True, expose_value=False))
        cmd.params += [option for option in options if known.isdisjoint(option.opts)]
        super().add_command(cmd, name)
