"""`graphflow action list`, `info`, `type`, `find`, `echo` and `send_goal`."""

from __future__ import annotations

from typing import Any

import click

from graphflow.cli import output
from graphflow.cli.messages.echo_options import collect_options, echo_options
from graphflow.cli.messages.types import agree, check_kind, check_order, names_of_type, type_of_word, use_project
from graphflow.cli.verbs import GraphVerbs
from graphflow.cli.words import ValueCommand, message_values, stdin_option
from graphflow.domain import domain_id
from graphflow.errors import UsageFault
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import ACTION_FEEDBACK, ACTION_FEEDBACK_TYPE, ACTION_SEND_GOAL
from graphflow.machines.matching import shared
from graphflow.names import did_you_mean, expand
from graphflow.wire.liveliness import Kind


@click.group(cls=GraphVerbs)
def action() -> None:
    """List actions and send goals to them."""


@action.command(name="list")
@click.option("-t", "--show-types", is_flag=True, help="Also show types.")
@click.option("-c", "--count-actions", is_flag=True, help="Print only the count.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(show_types: bool, count_actions: bool, as_json: bool) -> None:
    """List the names of all actions."""
    with View(domain_id()) as view:
        actions = view.cache.actions()
    if as_json:
        output.as_json(actions)
    elif count_actions:
        output.data(str(len(actions)))
    else:
        output.lines(f"{name} [{', '.join(types)}]" if show_types else name for name, types in actions.items())


@action.command(name="type")
@click.argument("name", metavar="ACTION")
def type_(name: str) -> None:
    """Print the type of an action."""
    with View(domain_id()) as view:
        output.lines(_types(view, expand(name, "/", "cli")))


@action.command()
@click.argument("type_name", metavar="TYPE")
@click.option("-c", "--count-actions", is_flag=True, help="Print only the count.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def find(type_name: str, count_actions: bool, as_json: bool) -> None:
    """List the actions of a type."""
    with View(domain_id()) as view:
        actions = view.cache.actions()
    output.listing(names_of_type(actions, type_name, only_count=count_actions), json=as_json)


@action.command()
@click.argument("name", metavar="ACTION")
@click.option("-t", "--show-types", is_flag=True, help="Also show the type each node uses.")
@click.option("-c", "--count", is_flag=True, help="Print only the count.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def info(name: str, show_types: bool, count: bool, as_json: bool) -> None:
    """Show which nodes serve an action and which send goals to it."""
    full = expand(name, "/", "cli")
    with View(domain_id()) as view:
        _types(view, full)
        found = {
            word: [
                (e.node_name, e.type.removesuffix(ACTION_FEEDBACK_TYPE))
                for e in view.cache.endpoints(kind, f"{full}{ACTION_FEEDBACK}")
            ]
            for word, kind in (("clients", Kind.SUBSCRIPTION), ("servers", Kind.PUBLISHER))
        }
    if as_json:
        nodes = {word: [{"node": n, "type": t} for n, t in entries] for word, entries in found.items()}
        output.as_json({"action": full, **nodes})
        return
    output.data(f"Action: {full}")
    for word, entries in found.items():
        output.data(f"Action {word}: {len(entries)}")
        if not count:
            output.lines(f"    {node} [{type_}]" if show_types else f"    {node}" for node, type_ in entries)
    if not found["servers"]:
        output.talk(f"no node serves {full}{did_you_mean(full, view.cache.served_actions())}")


@action.command()
@click.argument("name", metavar="ACTION")
@echo_options
def echo(name: str, **options: Any) -> int:
    """Show the feedback of an action's goals. Ctrl-C stops it."""
    from graphflow.cli.messages import echoing
    from graphflow.introspect.messages.definitions import learn

    full = expand(name, "/", "cli")
    use_project()
    with View(domain_id()) as view:
        [type_name, *_] = _types(view, full)
        learn(view, full, type_name)
    return echoing.run(f"{full}{ACTION_FEEDBACK}", f"{type_name}{ACTION_FEEDBACK_TYPE}", collect_options(options))


def _types(view: View, name: str) -> list[str]:
    """Return the types of an action in the graph."""
    actions = view.cache.actions()
    if name not in actions:
        served = view.cache.served_actions()
        raise UsageFault(
            f"there is no action {name}{view.cache.instead(name, served) or '; graphflow action list shows all'}"
        )
    return actions[name]


@action.command(name="send_goal", cls=ValueCommand, short_help="Send a goal given in YAML and wait for its result.")
@click.argument("name", metavar="ACTION")
@click.argument("type_name", metavar="TYPE", required=False)
@click.argument("values", nargs=-1)
@click.option("-f", "--feedback", is_flag=True, help="Show feedback as it arrives.")
@click.option(
    "--timeout",
    type=click.FloatRange(0, min_open=True),
    default=10.0,
    show_default=True,
    help="Seconds to wait until a server accepts.",
)
@stdin_option
@click.option("--json", "as_json", is_flag=True, help="Print events as lines of JSON.")
def send_goal(
    name: str,
    type_name: str | None,
    values: tuple[str, ...],
    feedback: bool,
    timeout: float,
    from_stdin: bool,
    as_json: bool,
) -> int:
    """Send a goal: VALUES are its fields in YAML, such as "{theta: 1.57}". Ctrl-C cancels the goal.

    Exit code 0: the goal succeeded, or Ctrl-C cancelled it; 1: it was rejected, aborted or lost.
    """
    from graphflow.cli.messages.sending import send
    from graphflow.msgs import registry
    from graphflow.msgs.values import from_plain

    use_project()
    check_order(name, type_name, "action send_goal")
    full = expand(name, "/", "cli")
    with View(domain_id()) as view:
        actions = view.cache.actions()
        alone = view.nobody_here() if full not in actions else ""
        known, served = actions.get(full), view.cache.served_actions()
        if type_name is None:
            types = _types(view, full)
            raise UsageFault(
                f"TYPE is missing; {full} is of type {types[0]}: graphflow action send_goal {full} {types[0]}"
            )
        if known:
            from graphflow.introspect.messages.definitions import learn

            learn(view, full, type_name if type_name in known or len(known) > 1 else known[0])
            for text in shared(view.cache.named(f"{full}{ACTION_SEND_GOAL}")):
                output.talk(f"WARNING: {text}")
    wanted = type_of_word(type_name, full, known or ())
    check_kind(wanted, "action")
    actual = agree(wanted, known, full) if known else wanted
    goal = from_plain(registry.interface_class(f"{actual}_Goal"), message_values(values, from_stdin=from_stdin))
    if not known:
        output.talk(f"there is no action {full} yet{did_you_mean(full, served) or alone}")
    return send(full, registry.interface_class(actual), goal, show_feedback=feedback, timeout=timeout, as_json=as_json)
