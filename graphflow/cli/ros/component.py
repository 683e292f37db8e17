"""`graphflow component`: load nodes into the processes of a running graph, and unload them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import groupby
from typing import TYPE_CHECKING, Any

import click

from graphflow.cli import output
from graphflow.cli.graphs.node_rows import NodeRow, node_rows
from graphflow.cli.verbs import GraphVerbs
from graphflow.errors import GraphFileError, SupervisorError, UsageFault
from graphflow.graph.model import LOG_LEVELS
from graphflow.names import did_you_mean
from graphflow.supervisor.control.choosing import choose
from graphflow.supervisor.control.client import ControlClient
from graphflow.workspace.executables import EXECUTABLES

if TYPE_CHECKING:
    from graphflow.supervisor.control.client import Event

ANSWER_LIMIT = 30.0
"""Seconds that the supervisor has to answer."""
_graph = click.option("--graph", help="Name of the running graph, if there are several.")


@click.group(cls=GraphVerbs)
def component() -> None:
    """Load nodes into running processes, and unload them."""


@component.command(name="list")
@click.argument("container", metavar="[PROCESS]", required=False)
@click.option("--containers-only", is_flag=True, help="Print only the processes.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@_graph
def list_(container: str | None, containers_only: bool, as_json: bool, graph: str | None) -> None:
    """List the processes of a graph and the nodes in each."""
    found = _containers(choose(graph).socket)
    if container is not None:
        name = _known_name(container, found)
        if name not in found:
            raise SupervisorError(f"the graph has no process {container!r}{did_you_mean(container, found)}")
        found = {name: found[name]}
    if as_json:
        output.as_json({name: {str(row["number"]): row["node"] for row in rows} for name, rows in found.items()})
        return
    for name, rows in found.items():
        if container is None or containers_only:
            output.data(name)
        if not containers_only:
            indent = "" if container is not None else "  "
            output.lines(f"{indent}{row['number']}  {row['node']}" for row in rows)


@component.command(short_help="Load a node into a running process.")
@click.argument("container", metavar="PROCESS")
@click.argument("what", metavar="MODULE:CLASS|PACKAGE")
@click.argument("plugin", metavar="[PLUGIN]", required=False)
@click.option("-n", "--node-name", help="Name of the node. [the class's]")
@click.option("--node-namespace", default="/", help="Namespace of the node.")
@click.option("--log-level", type=click.Choice(LOG_LEVELS, case_sensitive=False), help="Lowest level that is logged.")
@click.option("-r", "--remap-rule", "remaps", multiple=True, metavar="FROM:=TO", help="Remap a name.")
@click.option("-p", "--parameter", "params", multiple=True, metavar="NAME:=VALUE", help="Set a parameter.")
@click.option(
    "-e", "--extra-argument", "extra", multiple=True, metavar="NAME:=VALUE", help="Accepted for ROS 2; not used."
)
@click.option("-q", "--quiet", is_flag=True, help="Print only the number and the name of the node.")
@_graph
def load(
    container: str,
    what: str,
    plugin: str | None,
    node_name: str | None,
    node_namespace: str,
    log_level: str | None,
    remaps: tuple[str, ...],
    params: tuple[str, ...],
    extra: tuple[str, ...],
    quiet: bool,
    graph: str | None,
) -> None:
    """Load a node into a running process: a class, or a plugin of a ROS package.

    PROCESS is the name given as `process:` in the graph file, or a node that runs in the process.
    """
    from graphflow.cli.projects.node_lookup import find_class
    from graphflow.introspect.graph_view import refuse_taken_names
    from graphflow.runtime.args import parse_ros_args
    from graphflow.supervisor.launching.joining import check_component, planned_component

    run = choose(graph)
    if plugin is not None and "::" in plugin:
        plugin = plugin.rpartition("::")[2].lower()
    cls, rest = find_class(what, [plugin] if plugin else [])
    if rest:
        raise UsageFault(f"{what}: write MODULE:CLASS, or PACKAGE PLUGIN")
    words = [word for rule in remaps for word in ("-r", rule)] + [word for p in params for word in ("-p", p)]
    ros = parse_ros_args(["--ros-args", *words])
    interface = cls.interface()
    node = planned_component(interface, node_name or interface.node_name, node_namespace, ros, log_level or "")
    problems = check_component(node, interface)
    if problems:
        raise GraphFileError(problems)
    refuse_taken_names([node.name], run.domain, hint="give this one another name with -n NAME")
    container = _known_name(container, _containers(run.socket))
    answer = _ask(run.socket, do="load", container=container, node=node.to_json())
    if extra:
        output.talk(f"{', '.join(extra)}: not needed, messages within a process are always passed without copying")
    number, name = answer["number"], answer["node"]
    report = f"Loaded component {number} into '{container}' container node as '{name}'"
    output.data(f"{number}  {name}" if quiet else report)


@component.command(short_help="Run a node of a package in a process of its own.")
@click.argument("package")
@click.argument("plugin")
@click.option("-n", "--node-name", help="Name of the node. [the class's]")
@click.option("--node-namespace", help="Namespace of the node.")
@click.option("--log-level", type=click.Choice(LOG_LEVELS, case_sensitive=False), help="Lowest level that is logged.")
@click.option("-r", "--remap-rule", "remaps", multiple=True, metavar="FROM:=TO", help="Remap a name.")
@click.option("-p", "--parameter", "params", multiple=True, metavar="NAME:=VALUE", help="Set a parameter.")
@click.option(
    "-e", "--extra-argument", "extra", multiple=True, metavar="NAME:=VALUE", help="Accepted for ROS 2; not used."
)
@click.option("-c", "--container-node-name", help="Accepted for ROS 2; there is no container.")
def standalone(package: str, plugin: str, **options: Any) -> None:
    """Run a node of a package in a process of its own, as `graphflow run PACKAGE PLUGIN` does. Ctrl-C ends it."""
    from graphflow.cli.ros.run import run

    names = {"__node": options["node_name"], "__ns": options["node_namespace"]}
    rules = [f"{key}:={value}" for key, value in names.items() if value] + list(options["remaps"])
    words = [word for rule in rules for word in ("-r", rule)] + [w for p in options["params"] for w in ("-p", p)]
    words += ["--log-level", options["log_level"]] if options["log_level"] else []
    executable = plugin.rpartition("::")[2].lower()
    click.get_current_context().invoke(run, prefix=None, what=package, words=(executable, "--ros-args", *words))


@component.command()
@click.argument("container", metavar="PROCESS")
@click.argument("words", metavar="NUMBER|NODE...", nargs=-1, required=True)
@_graph
def unload(container: str, words: tuple[str, ...], graph: str | None) -> None:
    """Unload nodes from a running process. `component list` shows their numbers and names."""
    run = choose(graph)
    found = _containers(run.socket)
    container = _known_name(container, found)
    numbers = [int(word) if word.isdecimal() else _number_of(word, container, found) for word in words]
    for number in numbers:
        _ask(run.socket, do="unload", container=container, number=number)
        output.data(f"Unloaded component {number} from '{container}' container node")


@component.command()
@click.argument("package", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def types(package: str | None, as_json: bool) -> None:
    """List the plugins of the ROS packages that come with graphflow. Any class of a project can be loaded, too."""
    packages = {known for known, _ in EXECUTABLES}
    if package is not None and package not in packages:
        raise UsageFault(f"no plugin of a package {package!r} comes with graphflow{did_you_mean(package, packages)}")
    shown = [package] if package else sorted(packages)
    if as_json:
        output.as_json({known: [name for of, name in EXECUTABLES if of == known] for known in shown})
        return
    for known in shown:
        if package is None:
            output.data(known)
        indent = "" if package else "  "
        output.lines(f"{indent}{name}" for of, name in EXECUTABLES if of == known)


def _containers(socket: str) -> dict[str, list[NodeRow]]:
    """Return the rows of `ps` by process; a process of one node has that node's name."""
    return {name: list(rows) for name, rows in groupby(node_rows(socket), lambda row: row["process"] or row["node"])}


def _known_name(container: str, known: Collection[str]) -> str:
    """Return the name of a process, which may be given with or without a slash: ROS 2's are nodes."""
    name = container.lstrip("/")
    return next((form for form in (container, f"/{name}", name) if form in known), container)


def _number_of(node: str, container: str, containers: Mapping[str, list[NodeRow]]) -> int:
    """Return the number of a node in a process.

    Raises:
        SupervisorError: The process has no such node.
    """
    rows = {row["node"]: row["number"] for row in containers.get(container, [])}
    name = f"/{node.lstrip('/')}"
    if name not in rows:
        raise SupervisorError(f"process {container!r} has no node {name}{did_you_mean(name, rows)}")
    return rows[name]


def _ask(socket: str, **request: object) -> Event:
    with ControlClient(socket) as client:
        client.send(**request)
        answer = next(client.receive(ANSWER_LIMIT), {"event": "error", "message": "the supervisor has gone"})
    if answer["event"] == "error":
        raise SupervisorError(answer["message"])
    return answer
