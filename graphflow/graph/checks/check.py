"""Check of a Plan against the interfaces of its classes: names, types and values."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from graphflow.errors import EncodeError, GraphflowError, ParameterError, Place, Problem
from graphflow.graph.checks import rewritten
from graphflow.graph.plan import Plan, PlannedNode, PlannedStep, Setting, StepKind
from graphflow.interface import (
    COMMON_PARAMETERS,
    COMMON_SERVICES,
    LIFECYCLE_SERVICES,
    EndpointInfo,
    EndpointKind,
    GroupInfo,
    Interface,
    may_make,
)
from graphflow.msgs.base import Message
from graphflow.names import Kind, Resolver, did_you_mean, split
from graphflow.workspace.project import home_hint

ImportFault = Problem
Interfaces = Mapping[str, Interface | ImportFault]
"""The interface of each class, or the reason why it could not be imported, by class path."""


def check(plan: Plan, interfaces: Interfaces) -> list[Problem]:
    """Return all problems of a plan, in the order of its file."""
    problems: list[Problem] = []
    told: set[str] = set()
    for node in plan.nodes:
        fault = interfaces.get(node.class_path)
        if isinstance(fault, Problem) and fault.message in told:
            continue  # a module that cannot be imported is one fault, however many nodes are of it
        told |= {fault.message} if isinstance(fault, Problem) else set()
        problems += _check_program(node) if node.command else _check_node(node, interfaces)
    problems += _check_lifecycle(plan, interfaces)
    problems += _check_optional(plan, interfaces)
    problems += _check_shared_rules(plan, interfaces)
    problems += _check_types(plan, interfaces)
    for step in plan.steps:
        problems += _check_step(step, plan, interfaces)
    return problems


def _check_program(node: PlannedNode) -> Iterator[Problem]:
    program = node.command[0]
    if program == "graphflow" or (program == "ros2" and not node.executable):  # see `offer_ros2`
        return
    if shutil.which(program, path=node.env.get("PATH")) is not None:
        return
    if node.executable:
        text = f"there is no package {node.command[2]!r} in the workspace, and no ROS 2 is sourced"
        yield Problem(node.class_place, text)
    else:
        where = _why_not_run(node, program) if "/" in program else "it is not on the PATH"
        if " " in program and shutil.which(program.partition(" ")[0], path=node.env.get("PATH")) is not None:
            where = f"each word is an item of its own: command: {rewritten.command_of(program)}"
        elif rewritten.shell_word(node.command) == program:
            where = f"it is a shell's own: write {_in_shell(node)}"
        yield Problem(node.class_place, f"the program {program!r} cannot be started: {where}")


def _why_not_run(node: PlannedNode, program: str) -> str:
    """Return why a file cannot be run, and the correction."""
    if not os.path.isfile(program):
        return "it is a folder" if os.path.isdir(program) else f"there is no such file{home_hint(Path(program))}"
    interpreter = {".py": "python3", ".sh": "sh"}.get(Path(program).suffix)
    other = ""
    if interpreter and node.class_place.file.endswith((".yaml", ".yml")):
        other = f", or write command: {rewritten.flow([interpreter, *node.command])}"
    return f"it is not executable; make it so with: chmod +x {program}{other}"


def _in_shell(node: PlannedNode) -> str:
    """Return the correction of a command line that needs a shell."""
    if node.class_place.file.endswith(".py"):
        return "shell=True in ExecuteProcess"
    if node.class_place.file.endswith((".xml", ".launch")):
        return 'shell="true"'
    return f"command: {rewritten.in_shell(node.command)}"


def remarks_on_programs(plan: Plan) -> Iterator[Problem]:
    """Yield remarks on shell syntax in the arguments of programs, which are not run by a shell."""
    for node in plan.nodes:
        word = rewritten.shell_word(node.command)
        if word and word != node.command[0] and not node.executable:
            text = f"{word!r} is given to {node.command[0]} as a word, as no shell reads it; write {_in_shell(node)}"
            yield Problem(node.class_place, text)


def _check_node(node: PlannedNode, interfaces: Interfaces) -> Iterator[Problem]:
    interface = interfaces[node.class_path]
    if isinstance(interface, Problem):
        module = node.class_path.partition(":")[0]
        message = " ".join(interface.message.split())
        head = "" if module in message else f"{node.class_path}: "
        yield Problem(node.class_place, f"{head}{message}{_at(interface.place)}")
        return
    yield from _check_params(node, interface)
    yield from _check_remaps(node, interface)
    yield from _check_groups(node, interface)


def _check_lifecycle(plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    """Check that each `lifecycle:` applies to at least one lifecycle node."""
    fits: dict[Place, str] = {}
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if node.lifecycle and isinstance(interface, Interface) and fits.get(node.lifecycle_place) != "":
            fits[node.lifecycle_place] = "" if interface.is_managed else _class(interface)
    for place, cls in fits.items():
        if cls:
            yield Problem(place, f"{cls} has no life cycle: derive it from LifecycleNode, or leave `lifecycle:` out")


def _check_groups(node: PlannedNode, interface: Interface) -> Iterator[Problem]:
    handlers = {h.name: h for h in interface.handlers if h.kind != "task"}
    tasks = {h.name for h in interface.handlers if h.kind == "task"}
    for name, group in node.concurrency.items():
        for handler, place in group.handler_places.items():
            if handler in tasks:
                yield Problem(place, f"{handler} is a task, which runs alongside everything and is in no group")
            elif handler not in handlers and interface.dynamic_names is not True:
                near = did_you_mean(handler, handlers)
                yield Problem(place, f"{_class(interface)} has no handler {handler!r}{near}")
        is_known = name in interface.groups or interface.dynamic_names is True
        if not (is_known or group.change.handlers):
            near = did_you_mean(name, interface.groups)
            yield Problem(group.place, f"{_class(interface)} has no group {name!r}, and no handlers are listed{near}")
        here = [handlers[h] for h in group.change.handlers if h in handlers]
        if group.change.thread and here and all(h.is_async for h in here):
            names = ", ".join(h.name for h in here)
            yield Problem(group.place, f"thread: true is for `def` handlers, and {names} of {name!r} run on the loop")
        declared = interface.groups.get(name, GroupInfo())
        limit = group.change.limit if group.change.sets_limit else declared.limit
        when_full = group.change.when_full or declared.when_full
        if limit is None and when_full != "wait":
            yield Problem(
                group.place, f"{name!r} has no limit and is never full: when_full: {when_full} would never act"
            )


def _at(place: Place) -> str:
    return f" ({place})" if place.file else ""


def _check_params(node: PlannedNode, interface: Interface) -> Iterator[Problem]:
    known = [p.name for p in interface.params]
    misplaced: set[str] = set()
    for name, setting in node.params.items():
        declared = interface.param(name)
        if declared is None and interface.may_have(name):
            continue
        if declared is None:
            # Imported here: workers check too, and a graph without mistakes does without the models of files.
            from graphflow.graph.checks.parameter_slips import misplaced_key, set_in_a_method

            key, way = misplaced_key(name, known)
            way = way or set_in_a_method(name, interface.place)
            if interface.dynamic_names is not True and not setting.is_optional and key not in misplaced:
                yield Problem(
                    setting.place, f"{_class(interface)} has no parameter {name!r}{way or did_you_mean(name, known)}"
                )
            misplaced |= {key} - {""}  # an error for each entry below it would hide the others
            continue
        try:
            declared.fit(setting.value)
        except ParameterError as error:
            from graphflow.graph.checks.parameter_slips import value_correction

            way = value_correction(declared, setting)
            yield Problem(setting.place, f"{error}; {way}" if way else str(error))


def _check_optional(plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    """Check that each parameter set for many nodes at once is one of at least one node."""
    imported: list[Interface] = []
    if any(node.executable for node in plan.nodes):  # their parameters are not known
        return
    for interface in interfaces.values():
        if isinstance(interface, Problem) or interface.dynamic_names is True:
            return
        imported.append(interface)
    known = {*COMMON_PARAMETERS, *(param.name for interface in imported for param in interface.params)}
    optional = {
        (n, s.place) for node in plan.nodes for n, s in node.params.items() if s.is_optional and not s.is_unchecked
    }
    for name, place in sorted(optional):
        if name not in known and not any(interface.may_have(name) for interface in imported):
            yield Problem(place, f"no node of this graph has a parameter {name!r}{did_you_mean(name, known)}")


def _check_shared_rules(plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    """Check that each remap set for many nodes at once matches a name of at least one node."""
    fits: dict[Place, bool] = {}
    shared: dict[Place, tuple[str, list[str]]] = {}
    for node in plan.nodes:
        interface = None if node.command else interfaces[node.class_path]
        if isinstance(interface, Problem) or node.executable:  # the names of a program are not known
            return
        for rule in node.remaps if interface is not None else ():
            if rule.is_optional and not rule.is_unchecked and interface is not None:
                names = resolver(node)
                full = {names.full(e.name): e.name for e in interface.endpoints}
                fits[rule.place] = fits.get(rule.place, False) or _fits(rule.match, names, full, interface)
                shared.setdefault(rule.place, (rule.match, []))[1].extend(full.values())
    for place, (match, known) in shared.items():
        if not fits[place]:
            yield Problem(place, f"no node of this group has a topic or service {match!r}{did_you_mean(match, known)}")


def _fits(match: str, names: Resolver, full: Iterable[str], interface: Interface) -> bool:
    """Return whether a remap matches a name, or may match one made at run time."""
    if any(map(names.pattern(match).fullmatch, full)):
        return True
    dynamic = interface.dynamic_names
    return bool(dynamic) if "*" in match else may_make(dynamic, names.full(match))


def _class(interface: Interface) -> str:
    return interface.class_path.rpartition(":")[2]


def _check_remaps(node: PlannedNode, interface: Interface) -> Iterator[Problem]:
    names = resolver(node)
    full = {names.full(e.name): e.name for e in interface.endpoints}
    pair = {rule.match: rule for rule in node.remaps}
    if pair.keys() == {"from", "to"} and not any(_fits(match, names, full, interface) for match in pair):
        way = f"remap: {{{pair['from'].replacement}: {pair['to'].replacement}}}"
        yield Problem(pair["from"].place, f"a remap is written as a pair: {way}")
        return
    for rule in node.remaps:
        if not rule.is_optional and not _fits(rule.match, names, full, interface):
            help_ = did_you_mean(rule.match, full.values())
            if rule.replacement in (*full, *full.values()):
                help_ = f"; it is the other way round, from the node's name: {rule.replacement}: {rule.match}"
            yield Problem(
                rule.place,
                f"{_class(interface)} has no topic or service {rule.match!r}{help_}"
                + ("" if help_ or "*" in rule.match else _unread(interface, names.full(rule.match))),
            )


def _unread(interface: Interface, full_name: str) -> str:
    """Return a hint for a name that the source may make at run time: the declaration that allows it."""
    line = f'dynamic_names = ("*/{full_name.rpartition("/")[2]}",)'
    if not interface.unread:
        return f"; if it is made at run time, add to the class: {line}"
    places = ", ".join(str(place) for place in interface.unread[:3])
    return f"; the name made at {places} cannot be read there; if it is this one, add to the class: {line}"


def resolver(node: PlannedNode) -> Resolver:
    """Return the resolver of a node's names."""
    namespace, name = split(node.name)
    return Resolver(name, namespace, [rule.remap() for rule in node.remaps])


def _check_types(plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    """Check that each name has one type; endpoints of different types never communicate."""
    first: dict[tuple[Kind, str], tuple[list[str], str]] = {}
    """By name: the types that its first node may give it, and that node."""
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if not isinstance(interface, Interface):
            continue
        names = resolver(node)
        typed = [(_key(end, names), end) for end in interface.endpoints if end.type]  # else unknown from the source
        own: dict[tuple[Kind, str], list[str]] = {}
        for key, endpoint in typed:
            own.setdefault(key, []).append(endpoint.type)
        for (kind, name), endpoint in typed:
            types, owner = first.setdefault((kind, name), (own[kind, name], node.name))
            if owner == node.name:  # what a method makes may take the place of what the class declares
                clashes = endpoint.type != types[0] and not endpoint.is_made
            else:
                clashes = {*types}.isdisjoint(own[kind, name])
            if clashes:
                rule = next((r for r in node.remaps if names.full(r.replacement) == name), None)
                yield Problem(
                    rule.place if rule else node.class_place,
                    f"{kind} {name} is of type {types[0]} for {owner}, but {endpoint.type} for {node.name}",
                )


def _key(endpoint: EndpointInfo, names: Resolver) -> tuple[Kind, str]:
    kind: Kind = "topic" if endpoint.kind in ("publisher", "subscription") else "service"
    return kind, names.resolve(endpoint.name, kind)


def offered(plan: Plan, interfaces: Interfaces, kind: EndpointKind) -> dict[str, str]:
    """Return the declared endpoints of a kind: their types by full name."""
    found = {}
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if isinstance(interface, Interface):
            names = resolver(node)
            sort: Kind = "topic" if kind in ("publisher", "subscription") else "service"
            for endpoint in interface.endpoints:
                if endpoint.kind == kind:
                    found[names.resolve(endpoint.name, sort)] = endpoint.type
    return found


def _offered_anyway(plan: Plan, interfaces: Interfaces) -> dict[str, str]:
    """Return the services that every node has without declaring them: their types by full name."""
    found: dict[str, str] = {}
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if isinstance(interface, Interface):
            names = resolver(node)
            services = COMMON_SERVICES | (LIFECYCLE_SERVICES if interface.is_managed else {})
            found |= {names.resolve(f"~/{name}", "service"): type_ for name, type_ in services.items()}
    return found


def step_type(step: PlannedStep, plan: Plan, interfaces: Interfaces) -> str | None:
    """Return the type of the service or action of a step, if the file or the classes give it."""
    kind = _SERVERS.get(step.do)
    if kind is None:
        return None
    if step.type:
        return step.type
    anyway = _offered_anyway(plan, interfaces) if kind == "service" else {}
    return (anyway | offered(plan, interfaces, kind)).get(step.target)


_SERVERS: dict[StepKind, EndpointKind] = {"call": "service", "goal": "action"}


def _check_step(step: PlannedStep, plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    if step.do == "set":
        yield from _check_set(step, plan, interfaces)
        return
    kind = _SERVERS.get(step.do)
    if kind is None:
        return
    from graphflow.msgs import registry

    what = "action" if step.do == "goal" else "service"
    type_ = step_type(step, plan, interfaces)
    if type_ is None:
        if _may_have_more(plan, interfaces, step.target):
            return
        anyway = _offered_anyway(plan, interfaces) if kind == "service" else {}
        text = f"no node of this graph offers the {what} {step.target}"
        if other := _other_kind(step, plan, interfaces):
            yield Problem(step.target_place, f"{text}; it is {other}")
            return
        near = did_you_mean(step.target, offered(plan, interfaces, kind), hidden=anyway)
        folder = "action" if step.do == "goal" else "srv"
        outside = f" (for one outside the graph add type: package/{folder}/Name)"
        yield Problem(step.target_place, f"{text}{near}{outside}")
        return
    if not type_:  # it is offered, with a type unknown from the source
        return
    try:
        full = registry.full_name(type_)
        served = offered(plan, interfaces, kind).get(step.target)
        if served and registry.full_name(served) != full:
            yield Problem(step.target_place, f"{step.target} is of type {served}, not {type_}; leave out type:")
            return
        sent = f"{full}_Goal" if step.do == "goal" else registry.service_schema(full).request.name
        message_class = registry.interface_class(sent)
    except GraphflowError as error:
        yield Problem(step.target_place, str(error))
        return
    yield from _check_request(step, message_class)


def _other_kind(step: PlannedStep, plan: Plan, interfaces: Interfaces) -> str:
    """Return what a step's target is instead of a service or an action, with the right key; empty if unknown."""
    others: dict[EndpointKind, str] = {
        "action": f"an action: goal: {step.target}",
        "service": f"a service: call: {step.target}",
        "publisher": "a topic",
        "subscription": "a topic",
    }
    found = (word for kind, word in others.items() if step.target in offered(plan, interfaces, kind))
    return next(found, "a node" if any(node.name == step.target for node in plan.nodes) else "")


def _may_have_more(plan: Plan, interfaces: Interfaces, name: str) -> bool:
    """Return whether a graph may offer a name that no class declares: by programs, or at run time."""
    imported = [i for i in interfaces.values() if isinstance(i, Interface)]
    is_known = len(imported) == len(interfaces) and not any(node.command for node in plan.nodes)
    return not is_known or any(may_make(i.dynamic_names, name) for i in imported)


def _check_set(step: PlannedStep, plan: Plan, interfaces: Interfaces) -> Iterator[Problem]:
    node = next((node for node in plan.nodes if node.name == step.target and not node.command), None)
    if node is None:
        if step.type is None and not any(node.command for node in plan.nodes):
            near = did_you_mean(step.target, [n.name for n in plan.nodes])
            yield Problem(step.target_place, f"there is no node {step.target}{near}")
        return
    interface = interfaces[node.class_path]
    if isinstance(interface, Interface):
        settings = {name: Setting(value, step.request_place) for name, value in step.request.items()}
        yield from _check_params(replace(node, params=settings), interface)


def _check_request(step: PlannedStep, message_class: type[Message]) -> Iterator[Problem]:
    from graphflow.msgs.values import from_plain

    for name, value in step.request.items():
        try:
            from_plain(message_class, {name: value})
        except EncodeError as error:
            yield Problem(step.field_places.get(name, step.request_place), str(error))
