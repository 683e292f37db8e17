"""Commands on a graph file: correct options that were meant as arguments, which are written `NAME:=VALUE`."""

from __future__ import annotations

import click

from graphflow.names import nearest

OF_NODES = {
    "--params-file": "A parameter file belongs to a node of the graph file: params_file: FILE.yaml",
    "-p": "A parameter of a node goes below its params:, or is set by graphflow param set NODE NAME VALUE",
    "--ros-args": "ROS arguments are for one node, started by run. A graph file has params: and remap: for each node",
}
"""Options of `run` that concern one node, and the entries of a graph file that replace them."""


class GraphCommand(click.Command):
    """A command that answers an unknown option with the graph argument that was probably meant."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, list(args))
        except click.NoSuchOption as error:
            text = as_argument(error.option_name, args)
            known = [word for param in self.params for word in param.opts]
            if error.option_name == "-p" and text is not None and not text.startswith("p:="):
                way = f"An argument of the graph is written as {text}. {OF_NODES['-p']}"
                raise click.NoSuchOption("-p", way, ctx=ctx) from None
            if error.option_name in OF_NODES:
                raise click.NoSuchOption(error.option_name, OF_NODES[error.option_name], ctx=ctx) from None
            if text is None or nearest(error.option_name, known, cutoff=0.85) is not None:
                raise
            message = f"No such option {error.option_name!r}. An argument of the graph is written as {text}"
            raise click.NoSuchOption(
                error.option_name, f"{message}; up GRAPH --show-args lists them.", ctx=ctx
            ) from None


def as_argument(option: str, words: list[str]) -> str | None:
    """Convert an unknown option to an argument of a graph, with its value; None if it cannot be one.

    Args:
        option: Such as `--rate`.
        words: The command line.
    """
    if not option.startswith("--"):  # click reports only the first letter of a short option
        option = next((word for word in words if word.startswith(option) and ":=" in word), option)
        if ":=" in option:
            return option.lstrip("-")
    name = option.lstrip("-").replace("-", "_")  # as click names the parameter
    if not name.isidentifier():
        return None
    for place, word in enumerate(words):
        before, equals, after = word.partition("=")
        if before == option:
            following = words[place + 1] if words[place + 1 :] else "-"
            following = "VALUE" if following.startswith("-") or following.endswith((".yaml", ".yml")) else following
            return following if ":=" in following else f"{name}:={after if equals else following}"
    return f"{name}:=VALUE"
