"""A graph file and its arguments resolved into a Plan; every mistake found is reported, with its place."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from graphflow.errors import GraphFileError, InvalidName, Place
from graphflow.graph import params_file, source
from graphflow.graph.console import console_section
from graphflow.graph.faults import Problems, example, validated
from graphflow.graph.include import merged
from graphflow.graph.model import Arg, GraphFile, GroupSpec, NodeSpec, keys_of
from graphflow.graph.params_file import Section
from graphflow.graph.plan import Plan, PlannedGroup, PlannedNode, PlannedStep, Rule, Setting
from graphflow.graph.project import project_root, shown
from graphflow.graph.source import Source
from graphflow.graph.substitutions import SubstitutionError, Substitutions
from graphflow.interface import CALL_TIMEOUT, GroupChange
from graphflow.names import check_full_name, check_namespace, did_you_mean, expand, join, split


def load(path: Path, given: Sequence[str] = (), env: Mapping[str, str] | None = None) -> Plan:
    """Read and resolve a graph file.

    Args:
        path: The file.
        given: Arguments from the command line, `name:=value`.
        env: The environment; the process's own if None.

    Raises:
        GraphFileError: Every mistake that could be found.
    """
    return resolve(source.read_file(path, shown(path)), path, given, env)


def resolve(src: Source, path: Path, given: Sequence[str] = (), env: Mapping[str, str] | None = None) -> Plan:
    """Resolve what `source.read` found. Arguments and errors as for `load`."""
    problems = Problems()
    if not isinstance(src.data, dict):
        what = "the file is empty; " if src.data is None else ""
        problems.add(src.place(()), f"{what}a graph file is a mapping with the key 'nodes'{example('nodes')}")
        problems.raise_any()
    src, folders = merged(src, path, problems.add)
    args = _arguments(src, given, problems)
    substitutions = {file: Substitutions(args, str(folder), env) for file, folder in folders.items()}
    src = _substituted(src, substitutions, problems)
    model = validated(src, problems)
    if model is None:
        problems.raise_any()
    assert model is not None
    files = _ParamsFiles(src, folders, problems)
    nodes = _nodes(src, model, files, problems)
    files.refuse_strays([n.name for n in nodes.values()])
    _check_env(nodes.values(), problems)
    steps = _steps(src, model, problems)
    ordered_nodes, ordered_steps = _order(src, model, nodes, steps, problems)
    console = console_section(src, problems.add)
    problems.raise_any()
    return Plan(
        name=model.name or path.stem,
        file=src.file,
        root=str(project_root(path)),
        nodes=tuple(ordered_nodes),
        steps=tuple(ordered_steps),
        args=args,
        domain=model.domain,
        deadlock=model.deadlock,  # type: ignore[arg-type]  # its validator has looked
        call_timeout={None: CALL_TIMEOUT, "never": None}.get(model.call_timeout, model.call_timeout),
        console=console,
    )


def _arguments(src: Source, given: Sequence[str], problems: Problems) -> dict[str, Any]:
    declared = src.data.get("args") or {}
    if not isinstance(declared, dict):
        return {}
    values: dict[str, Any] = {}
    for word in given:
        name, arrow, text = word.partition(":=")
        if not arrow or not name:
            problems.add(Place("command line"), f"{word!r}: an argument is written name:=value")
        elif name not in declared:
            help_ = did_you_mean(name, declared) or "; the file declares none under args:"
            problems.add(Place("command line"), f"there is no argument {name!r}{help_}")
        else:
            values[name] = _given(text, declared[name])
    for name, spec in declared.items():
        place = src.key_place(("args", name))
        has_default = isinstance(spec, dict) and "default" in spec
        if name not in values and has_default:
            values[name] = spec["default"]
        elif name not in values:
            values[name] = ""
            # What is wrong with the declaration itself is reported when it is validated.
            if spec is None or (isinstance(spec, dict) and spec.keys() <= set(keys_of(Arg))):
                problems.add(place, f"argument {name!r} has no default: give it as {name}:=VALUE")
        choices = spec.get("choices") if isinstance(spec, dict) else None
        if isinstance(choices, list) and choices and values[name] not in choices:
            problems.add(
                place, f"argument {name!r} is {values[name]!r}, but must be one of {', '.join(map(str, choices))}"
            )
    return values


def _given(text: str, spec: Any) -> Any:
    """An argument's value from the command line: YAML, but text where the default is text."""
    try:
        value = source.read(text, "command line").data
    except GraphFileError:
        return text
    wants_text = isinstance(spec, dict) and isinstance(spec.get("default"), str)
    return text if wants_text and not isinstance(value, str) else value


def _substituted(src: Source, substitutions: Mapping[str, Substitutions], problems: Problems) -> Source:
    """The same source with every substitution made, in keys too; places move with the values."""
    places, keys = {}, {}

    def one(value: Any, place: Place) -> Any:
        try:
            return substitutions[place.file].apply(value)
        except SubstitutionError as error:
            problems.add_unknown(place, str(error))
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
                    problems.add(src.key_place((*old, key)), f"the key {key!r} becomes {name!r}, which is already here")
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


class _ParamsFiles:
    """The parameter files of a graph; each is read once.

    Args:
        folders: The folder that relative paths start from, by the file they are written in.
    """

    def __init__(self, src: Source, folders: Mapping[str, Path], problems: Problems) -> None:
        self._src, self._folders, self._problems = src, folders, problems
        self._files: dict[Path, list[Section]] = {}

    def params(self, spec: NodeSpec, at: source.Path, node: str) -> dict[str, Setting]:
        """What a node's files have for it, later files first."""
        found: dict[str, Setting] = {}
        names = [spec.params_file] if isinstance(spec.params_file, str) else spec.params_file
        for i, name in enumerate(names):
            place = self._src.place((*at, i))
            path = self._folders[place.file] / name
            if path not in self._files:
                self._files[path] = self._read(path, place)
            sections = self._files[path]
            if sections and not any(s.fits(node) for s in sections):
                patterns = [s.pattern for s in sections]
                self._problems.add(place, f"{name} has nothing for {node}{did_you_mean(node, patterns)}")
            found |= params_file.params_for(sections, node)
        return found

    def _read(self, path: Path, place: Place) -> list[Section]:
        if not path.is_file():
            near = did_you_mean(path.name, [f.name for f in path.parent.glob("*.yaml")])
            self._problems.add(place, f"there is no file {shown(path)}{near}")
            return []
        try:
            return params_file.read(path, shown(path))
        except GraphFileError as error:
            self._problems += error.problems
            return []

    def refuse_strays(self, nodes: list[str]) -> None:
        """Report sections for nodes that the graph does not have."""
        for sections in self._files.values():
            self._problems += params_file.strays(sections, nodes)


def _nodes(src: Source, model: GraphFile, files: _ParamsFiles, problems: Problems) -> dict[str, PlannedNode]:
    """The nodes by their keys in the file."""
    nodes: dict[str, PlannedNode] = {}
    taken: dict[str, Place] = {}
    for key, spec in model.nodes.items():
        place = src.key_place(("nodes", key))
        name = _node_name(src, key, spec, problems)
        if name is None:
            continue
        if name in taken:
            problems.add(place, f"there are two nodes {name}; the other is on line {taken[name].line}")
        taken[name] = place
        base: source.Path = ("nodes", key)
        nodes[key] = PlannedNode(
            name=name,
            class_path=spec.class_,
            place=place,
            class_place=src.place((*base, "class")),
            params=files.params(spec, (*base, "params_file"), name)
            | params_file.flatten(src, spec.params, (*base, "params"), problems),
            remaps=_remaps(src, spec.remap, (*base, "remap"), name, problems),
            process=spec.process,
            env={k: str(v) for k, v in spec.env.items()},
            after=_names(spec.after),
            concurrency=_concurrency(src, spec.concurrency, (*base, "concurrency"), problems),
        )
    if not model.nodes:
        problems.add(src.place(("nodes",)), "there is no node")
    return nodes


def _concurrency(
    src: Source, groups: Mapping[str, GroupSpec], path: source.Path, problems: Problems
) -> dict[str, PlannedGroup]:
    found: dict[str, PlannedGroup] = {}
    taken: dict[str, str] = {}
    for name, spec in groups.items():
        at = (*path, name, "handlers") if (*path, name, "handlers") in src.places else (*path, name)
        places: dict[str, Place] = {}
        for i, handler in enumerate(_names(spec.handlers)):
            places[handler] = src.place((*at, i))
            if handler in taken:
                text = f"{handler} is put in two groups, {taken[handler]!r} and {name!r}; it can be in only one"
                problems.add(places[handler], text)
            taken[handler] = name
        limit = None if spec.limit == "none" else spec.limit
        change = GroupChange(tuple(places), limit, spec.limit is not None, spec.when_full, spec.thread)  # type: ignore[arg-type]
        found[name] = PlannedGroup(change, src.key_place((*path, name)), places)
    return found


def _node_name(src: Source, key: str, spec: NodeSpec, problems: Problems) -> str | None:
    """The full name of a node; None when it has no legal one."""
    place = src.key_place(("nodes", key))
    try:
        namespace = check_namespace(spec.namespace)
    except InvalidName as error:
        problems.add(src.place(("nodes", key, "namespace")), str(error))
        return None
    if key.startswith("/") and spec.namespace:
        problems.add(
            src.place(("nodes", key, "namespace")),
            f"{key} is a full name, so a namespace would have no effect; name the node {split(key)[1]}, or remove this",
        )
    try:
        return check_full_name(join(namespace, key), "node name")
    except InvalidName as error:
        problems.add(place, str(error))
        return None


def _check_env(nodes: Iterable[PlannedNode], problems: Problems) -> None:
    """A process has one environment: nodes that share it must not contradict each other."""
    seen: dict[tuple[str, str], tuple[str, str]] = {}
    for node in nodes:
        for name, value in node.env.items() if node.process else ():
            first, owner = seen.setdefault((node.process, name), (value, node.name))
            if first != value:
                text = f"{name}={value} contradicts {name}={first} of {owner}, which shares process {node.process!r}"
                problems.add(node.place, text)


def _remaps(
    src: Source, remap: Mapping[str, str], path: source.Path, node: str, problems: Problems
) -> tuple[Rule, ...]:
    rules = []
    namespace, name = split(node)
    for match, replacement in remap.items():
        place = src.key_place((*path, match))
        try:
            if match.startswith("__"):
                raise InvalidName(
                    f"{match!r} cannot be remapped; a node's name is its key, its namespace goes under namespace:"
                )
            expand(match, namespace, name)
            expand(replacement, namespace, name)
        except InvalidName as error:
            problems.add(place, str(error))
            continue
        rules.append(Rule(match, replacement, place))
    return tuple(rules)


def _steps(src: Source, model: GraphFile, problems: Problems) -> list[PlannedStep]:
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
                field_places={field: src.key_place(("steps", name, "request", field)) for field in spec.request},
                type=spec.type,
                after=_names(spec.after),
                timeout=float(spec.timeout),
            )
        )
    return steps


def _names(after: str | list[str]) -> tuple[str, ...]:
    return (after,) if isinstance(after, str) else tuple(after)


def _order(
    src: Source,
    model: GraphFile,
    nodes: dict[str, PlannedNode],
    steps: list[PlannedStep],
    problems: Problems,
) -> tuple[list[PlannedNode], list[PlannedStep]]:
    """Replace keys by full names in every `after`; check that each names something and none waits for itself."""
    known = {*(n.name for n in nodes.values()), *(s.name for s in steps)}
    reported = (model.nodes.keys() | model.steps.keys()) - nodes.keys() - known

    def resolved(after: tuple[str, ...], path: source.Path) -> tuple[str, ...]:
        names = []
        for i, written in enumerate(after):
            name = nodes[written].name if written in nodes else written
            if name in known:
                names.append(name)
            elif written not in reported:
                help_ = did_you_mean(written, known | reported)
                problems.add(src.place((*path, "after", i)), f"after: there is no node or step {written!r}{help_}")
        return tuple(names)

    for step in steps:
        if step.name in nodes or step.name in (n.name for n in nodes.values()):
            problems.add(step.place, f"a node is already called {step.name!r}; give the step another name")
    ordered_nodes = [replace(n, after=resolved(n.after, ("nodes", key))) for key, n in nodes.items()]
    ordered_steps = [replace(s, after=resolved(s.after, ("steps", s.name))) for s in steps]
    items: list[PlannedNode | PlannedStep] = [*ordered_nodes, *ordered_steps]
    places = {item.name: item.place for item in items}
    cycle = find_cycle({item.name: item.after for item in items}) or _process_cycle(items, places)
    if cycle:
        ring = " after ".join([*cycle, cycle[0]])
        problems.add(places[cycle[0]], f"waits for itself: {ring}; remove one of these after:")
    return ordered_nodes, ordered_steps


def _process_cycle(items: list[PlannedNode | PlannedStep], places: dict[str, Place]) -> list[str]:
    """A cycle among processes: each is started as a whole, so all its nodes wait for what any of them waits for."""
    whole = {i.name: f"process {i.process}" for i in items if isinstance(i, PlannedNode) and i.process}
    edges: dict[str, set[str]] = {}
    for item in items:
        name = whole.get(item.name, item.name)
        places.setdefault(name, item.place)
        edges.setdefault(name, set()).update({whole.get(a, a) for a in item.after} - {name})
    return find_cycle({name: sorted(after) for name, after in edges.items()})


def find_cycle(edges: Mapping[str, Iterable[str]]) -> list[str]:
    """Names that wait for one another in a cycle, each after the next; empty when there is no cycle."""
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
