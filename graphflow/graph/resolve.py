"""A graph file and its arguments resolved into a Plan; every mistake found is reported, with its place."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from graphflow.errors import GraphFileError, InvalidName, Place, Problem
from graphflow.graph import source
from graphflow.graph.model import Arg, GraphFile, NodeSpec, StepSpec, keys_of
from graphflow.graph.plan import Plan, PlannedNode, PlannedStep, Rule, Setting
from graphflow.graph.project import project_root, shown
from graphflow.graph.source import Source
from graphflow.graph.substitutions import SubstitutionError, Substitutions
from graphflow.names import check_full_name, check_namespace, did_you_mean, expand, join, split

_MODELS: dict[str, type[BaseModel]] = {"args": Arg, "nodes": NodeSpec, "steps": StepSpec}


def load(path: Path, given: Sequence[str] = (), env: Mapping[str, str] | None = None) -> Plan:
    """Read and resolve a graph file.

    Args:
        path: The file.
        given: Arguments from the command line, `name:=value`.
        env: The environment; the process's own if None.

    Raises:
        GraphFileError: Every mistake that could be found.
    """
    file = shown(path)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise GraphFileError([Problem(Place(file), f"cannot be read: {error.strerror}")]) from None
    except UnicodeDecodeError:
        raise GraphFileError([Problem(Place(file), "is not UTF-8 text")]) from None
    return resolve(source.read(text, file), path, given, env)


class _Problems(list[Problem]):
    def add(self, place: Place, message: str) -> None:
        self.append(Problem(place, message))

    def raise_any(self) -> None:
        if self:
            raise GraphFileError(self)


def resolve(src: Source, path: Path, given: Sequence[str] = (), env: Mapping[str, str] | None = None) -> Plan:
    """Resolve what `source.read` found. Arguments and errors as `load`."""
    problems = _Problems()
    if not isinstance(src.data, dict):
        problems.add(src.place(()), "a graph file is a mapping with the key 'nodes'")
        problems.raise_any()
    args = _arguments(src, given, problems)
    substitutions = Substitutions(args, str(path.resolve().parent), env)
    src = _substituted(src, substitutions, problems)
    model = _validated(src, problems)
    if model is None:
        problems.raise_any()
    assert model is not None
    nodes = _nodes(src, model, problems)
    steps = _steps(src, model, problems)
    _order(src, model, nodes, steps, problems)
    problems.raise_any()
    return Plan(
        name=model.name or path.stem,
        file=src.file,
        root=str(project_root(path)),
        nodes=tuple(nodes),
        steps=tuple(steps),
        args=args,
        domain=model.domain,
    )


def _arguments(src: Source, given: Sequence[str], problems: _Problems) -> dict[str, Any]:
    declared = src.data.get("args") or {}
    if not isinstance(declared, dict):
        return {}
    values: dict[str, Any] = {}
    for word in given:
        name, arrow, text = word.partition(":=")
        if not arrow or not name:
            problems.add(Place("command line"), f"{word!r}: an argument is written name:=value")
        elif name not in declared:
            problems.add(Place("command line"), f"there is no argument {name!r}{did_you_mean(name, declared)}")
        else:
            try:
                values[name] = source.read(text, "command line").data
            except GraphFileError:
                values[name] = text
    for name, spec in declared.items():
        place = src.key_place(("args", name))
        has_default = isinstance(spec, dict) and "default" in spec
        if name not in values and has_default:
            values[name] = spec["default"]
        elif name not in values:
            if isinstance(spec, dict) or spec is None:
                problems.add(place, f"argument {name!r} has no default: give it as {name}:=VALUE")
            else:
                problems.add(place, f"write {name}: {{default: {spec}}}")
            values[name] = ""
        choices = spec.get("choices") if isinstance(spec, dict) else None
        if isinstance(choices, list) and choices and values[name] not in choices:
            problems.add(
                place, f"argument {name!r} is {values[name]!r}, but must be one of {', '.join(map(str, choices))}"
            )
    return values


def _substituted(src: Source, substitutions: Substitutions, problems: _Problems) -> Source:
    """The same source with every substitution made, in keys too; places follow the values."""
    places, keys = {}, {}

    def one(value: Any, place: Place) -> Any:
        try:
            return substitutions.apply(value)
        except SubstitutionError as error:
            problems.add(place, str(error))
            return value

    def walk(value: Any, old: source.Path, new: source.Path) -> Any:
        places[new] = src.place(old)
        if old in src.keys:
            keys[new] = src.keys[old]
        if isinstance(value, dict):
            result: dict[str, Any] = {}
            for key, item in value.items():
                name = str(one(key, src.key_place((*old, key))))
                if name in result:
                    problems.add(
                        src.key_place((*old, key)), f"the key {key!r} becomes {name!r}, which stands here already"
                    )
                result[name] = walk(item, (*old, key), (*new, name))
            return result
        if isinstance(value, list):
            return [walk(item, (*old, i), (*new, i)) for i, item in enumerate(value)]
        return one(value, src.place(old))

    # Arguments are what substitutions are made from: their section stays as it is.
    data = {k: (v if k == "args" else walk(v, (k,), (k,))) for k, v in src.data.items()}
    places[()] = src.place(())
    for path, place in src.places.items():
        if path[:1] == ("args",):
            places[path] = place
    keys.update({path: place for path, place in src.keys.items() if path[:1] == ("args",) or len(path) == 1})
    return Source(data, places, keys)


def _validated(src: Source, problems: _Problems) -> GraphFile | None:
    try:
        return GraphFile.model_validate(src.data)
    except ValidationError as error:
        seen = set()
        for fault in error.errors():
            path = tuple(p for p in fault["loc"])
            # Alternatives of a union report once each, under a last part that names the alternative.
            while path and path not in src.places and path not in src.keys and fault["type"] != "missing":
                path = path[:-1]
            place, message = _fault(src, path, fault)
            if (place, message) not in seen:
                seen.add((place, message))
                problems.add(place, message)
        return None


def _fault(src: Source, path: source.Path, fault: Any) -> tuple[Place, str]:
    known = keys_of(_MODELS[str(path[0])]) if len(path) == 3 and path[0] in _MODELS else keys_of(GraphFile)
    where = ".".join(str(p) for p in path)
    kind = fault["type"]
    if kind == "extra_forbidden":
        return src.key_place(path), f"unknown key {str(path[-1])!r}{did_you_mean(str(path[-1]), known)}"
    if kind == "missing":
        return src.key_place(path[:-1]), f"the key {str(path[-1])!r} is missing"
    if kind == "value_error":
        return src.place(path), str(fault["ctx"]["error"])
    wanted = {
        "dict_type": "a mapping",
        "model_type": "a mapping",
        "string_type": "text",
        "list_type": "a list",
        "int_type": "a whole number",
        "float_type": "a number",
        "bool_type": "true or false",
        "greater_than": f"more than {fault.get('ctx', {}).get('gt', '')}",
        "greater_than_equal": f"{fault.get('ctx', {}).get('ge', '')} or more",
    }.get(kind, fault["msg"])
    return src.place(path), f"{where}: expected {wanted}, got {fault['input']!r}"


def _nodes(src: Source, model: GraphFile, problems: _Problems) -> list[PlannedNode]:
    nodes: list[PlannedNode] = []
    taken: dict[str, Place] = {}
    for key, spec in model.nodes.items():
        place = src.key_place(("nodes", key))
        try:
            name = check_full_name(join(check_namespace(spec.namespace), key), "node name")
        except InvalidName as error:
            problems.add(place, str(error))
            continue
        if name in taken:
            problems.add(place, f"there are two nodes {name}; the other is in line {taken[name].line}")
        taken[name] = place
        base: source.Path = ("nodes", key)
        nodes.append(
            PlannedNode(
                name=name,
                class_path=spec.class_,
                place=place,
                class_place=src.place((*base, "class")),
                params=_params(src, spec.params, (*base, "params"), problems),
                remaps=_remaps(src, spec.remap, (*base, "remap"), name, problems),
                process=spec.process,
                env={k: str(v) for k, v in spec.env.items()},
                after=_names(spec.after),
            )
        )
    if not model.nodes:
        problems.add(src.place(("nodes",)), "there is no node")
    return nodes


def _params(src: Source, params: Mapping[str, Any], path: source.Path, problems: _Problems) -> dict[str, Setting]:
    """Parameters with nested mappings flattened by dots, as in ROS's parameter files."""
    found: dict[str, Setting] = {}

    def walk(prefix: str, values: Mapping[str, Any], at: source.Path) -> None:
        for key, value in values.items():
            place = src.place((*at, key))
            if isinstance(value, dict):
                walk(f"{prefix}{key}.", value, (*at, key))
            elif value is None:
                problems.add(src.key_place((*at, key)), f"parameter {prefix + key!r} has no value")
            else:
                found[prefix + key] = Setting(value, place)

    walk("", params, path)
    return found


def _remaps(
    src: Source, remap: Mapping[str, str], path: source.Path, node: str, problems: _Problems
) -> tuple[Rule, ...]:
    rules = []
    namespace, name = split(node)
    for match, replacement in remap.items():
        place = src.key_place((*path, match))
        try:
            if match.startswith("__"):
                raise InvalidName(f"{match!r}: name and namespace of a node are its key and `namespace:`")
            expand(match, namespace, name)
            expand(replacement, namespace, name)
        except InvalidName as error:
            problems.add(place, str(error))
            continue
        rules.append(Rule(match, replacement, place))
    return tuple(rules)


def _steps(src: Source, model: GraphFile, problems: _Problems) -> list[PlannedStep]:
    steps = []
    for name, spec in model.steps.items():
        call_place = src.place(("steps", name, "call"))
        try:
            call = expand(spec.call, "/", "graph")
        except InvalidName as error:
            problems.add(call_place, str(error))
            continue
        steps.append(
            PlannedStep(
                name=name,
                call=call,
                place=src.key_place(("steps", name)),
                call_place=call_place,
                request=spec.request,
                request_place=src.place(("steps", name, "request")),
                type=spec.type,
                after=_names(spec.after),
                timeout=float(spec.timeout),
            )
        )
    return steps


def _names(after: str | list[str]) -> tuple[str, ...]:
    return (after,) if isinstance(after, str) else tuple(after)


def _order(
    src: Source, model: GraphFile, nodes: list[PlannedNode], steps: list[PlannedStep], problems: _Problems
) -> None:
    """Replace keys by full names in every `after`; check that each names something and none waits for itself."""
    full = {key: join(check_namespace(spec.namespace), key) for key, spec in model.nodes.items()}
    key_of = {name: key for key, name in full.items()}
    known = {*(n.name for n in nodes), *(s.name for s in steps)}

    def resolved(after: tuple[str, ...], path: source.Path) -> tuple[str, ...]:
        names = tuple(full.get(a, a) for a in after)
        for written, name in zip(after, names, strict=True):
            if name not in known:
                help_ = did_you_mean(written, known)
                problems.add(src.place((*path, "after")), f"after: there is no node or step {written!r}{help_}")
        return tuple(n for n in names if n in known)

    for i, node in enumerate(nodes):
        nodes[i] = replace(node, after=resolved(node.after, ("nodes", key_of.get(node.name, node.name))))
    for i, step in enumerate(steps):
        steps[i] = replace(step, after=resolved(step.after, ("steps", step.name)))
    items: list[PlannedNode | PlannedStep] = [*nodes, *steps]
    places = {item.name: item.place for item in items}
    cycle = find_cycle({item.name: item.after for item in items})
    if cycle:
        problems.add(places[cycle[0]], f"waits for itself: {' after '.join([*cycle, cycle[0]])}")


def find_cycle(edges: Mapping[str, Iterable[str]]) -> list[str]:
    """Names that wait for one another in a ring, each after the next; empty when there is no ring."""
    done: set[str] = set()
    for start in edges:
        path: list[str] = []
        stack: list[tuple[str, list[str]]] = [(start, list(edges.get(start, ())))]
        while stack:
            name, rest = stack[-1]
            if name not in path:
                path.append(name)
            if not rest:
                done.add(name)
                path.pop()
                stack.pop()
                continue
            follower = rest.pop()
            if follower in path:
                return path[path.index(follower) :]
            if follower not in done:
                stack.append((follower, list(edges.get(follower, ()))))
    return []
