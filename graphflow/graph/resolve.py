"""Resolution of a graph file and its arguments to a Plan, with all mistakes and their places."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from graphflow.console.section import console_section
from graphflow.console.subjects import subjects
from graphflow.errors import GraphFileError, InvalidName, Place
from graphflow.folders import newest_logs
from graphflow.graph import params_file
from graphflow.graph.checks.order import ordered
from graphflow.graph.checks.unused_arguments import unused_arguments
from graphflow.graph.checks.validation import Problems, example, validated
from graphflow.graph.expansion.arguments import given_values
from graphflow.graph.expansion.expand import Expansion
from graphflow.graph.model import BLOCKS, FROM_GROUPS, NO_CLASS, GraphFile, GroupSpec, NodeSpec, RestartSpec
from graphflow.graph.params_file import Section
from graphflow.graph.plan import Plan, PlannedGroup, PlannedNode, PlannedStep, Rule, Setting
from graphflow.graph.programs import Programs, executable_of
from graphflow.interface import CALL_TIMEOUT, GroupChange
from graphflow.launchfiles.reading import read
from graphflow.launchfiles.recorded import Describe
from graphflow.machines.restarts import BACKOFF, Backoff
from graphflow.markup import source
from graphflow.markup.source import Source
from graphflow.markup.substitutions import Outside, Run
from graphflow.markup.tree import Item, source_of, tree
from graphflow.names import Resolver, check_references, expand, split
from graphflow.workspace.project import no_file, project_root, shown

_ANYBODY = (
    "allow_control: whoever reaches this graph over the network can load code into its processes; remove it, unless "
    "ROS 2's load_node is needed (graphflow component does without)"
)


def load(
    path: Path,
    given: Sequence[str] = (),
    env: Mapping[str, str] | None = None,
    *,
    run: Run | None = None,
    describe: Describe | None = None,
) -> Plan:
    """Read and resolve a graph file.

    Args:
        path: The file.
        given: Arguments from the command line, `name:=value`.
        env: The environment; the process's own if None.
        run: Runs the programs of `$(command ...)`; without it, such substitutions stay as they are.
        describe: Runs launch files in Python; they are refused without.

    Raises:
        GraphFileError: The file has mistakes; all that could be found.
    """
    problems = Problems()
    top = read(
        path,
        shown(path),
        problems.add,
        describe=describe,
        values=given_values(given),
        remark=problems.remark,
        leave_out=problems.leave_out,
    )
    return _resolve(top, path, given, env, problems, run=run, describe=describe)


def resolve(src: Source, path: Path, given: Sequence[str] = (), env: Mapping[str, str] | None = None) -> Plan:
    """Resolve a graph file that has been read. Arguments and errors as for `load`."""
    return _resolve(tree(src), path, given, env, Problems())


def _resolve(
    top: Item,
    path: Path,
    given: Sequence[str],
    env: Mapping[str, str] | None,
    problems: Problems,
    *,
    run: Run | None = None,
    describe: Describe | None = None,
) -> Plan:
    if not isinstance(top.value, dict):
        what = "the file is empty; " if top.value is None else ""
        problems.add(top.place, f"{what}a graph file is a mapping with the key 'nodes'{example('nodes')}")
        problems.raise_any()
    root, name = project_root(path), path.stem.removesuffix(".launch")
    given_name = top.entries.get("name")
    logs = newest_logs(name if given_name is None else str(given_name.value))
    outside = Outside(os.environ if env is None else env, root, logs, run)
    expansion = Expansion(given, outside, problems, describe)
    expansion.file(top, path)
    if not problems and not top.entries.keys() & {*BLOCKS} and top.place.file not in problems.launch_files:
        problems.add(top.place, "the key 'nodes' is missing")
    src = source_of(expansion.whole(top))
    model = validated(GraphFile, src, problems)
    if model is None:
        problems.raise_any()
    assert model is not None
    files = _ParamsFiles(src, expansion.files, problems)
    programs = Programs(src, expansion.files, outside, problems)
    nodes = _nodes(src, model, files, programs, problems)
    # Problems of nodes that are left out do not count, and `after` ignores such nodes.
    expansion.left_out |= {str(name): problem.place for name, problem in programs.left_out.items()}
    problems.forget(map(str, programs.left_out))
    problems.left_out += programs.left_out.values()
    # Programs that are not installed are no mistake of a launch file, unless nothing else is left of it.
    if nodes:
        problems.remarks += problems.left_out
    else:
        problems += problems.left_out
    files.refuse_strays([n.name for n in nodes.values()])
    _check_env(nodes.values(), problems)
    steps = _steps(src, model, problems)
    ordered_nodes, ordered_steps = ordered(src, nodes, steps, expansion, problems)
    console = console_section(src, problems.add)
    if model.net.allow_control:
        problems.remark(src.key_place(("net", "allow_control")), _ANYBODY)
    if not problems.launch_files:  # in ROS, launch files may have arguments for the sake of others
        for unused in unused_arguments(expansion.tops, expansion.followed):
            problems.remark(*unused)
    problems.raise_any()
    return Plan(
        name=model.name or name,
        file=src.file,
        root=str(root),
        nodes=tuple(ordered_nodes),
        steps=tuple(ordered_steps),
        args=expansion.arguments.values,
        domain=model.domain,
        deadlock=model.deadlock,  # type: ignore[arg-type]  # one of the policies, by its validator
        call_timeout={None: CALL_TIMEOUT, "never": None}.get(model.call_timeout, model.call_timeout),
        strategy=model.strategy,
        allow_control=model.net.allow_control,
        console=console,
        panes=tuple(subjects(src)),
        remarks=tuple(map(str, problems.remarks)),
    )


class _ParamsFiles:
    """The parameter files of a graph; each is read at most once.

    Args:
        graph_files: The graph files, to which paths are relative, by the names that messages have for them.
    """

    def __init__(self, src: Source, graph_files: Mapping[str, Path], problems: Problems) -> None:
        self._src, self._graph_files, self._problems = src, graph_files, problems
        self._files: dict[Path, list[Section]] = {}
        self._strict: set[Path] = set()
        """Files named by graph files: all their sections must be for nodes of the graph, unlike in ROS."""

    def params(self, spec: NodeSpec, at: source.Path, node: str) -> dict[str, Setting]:
        """Return the parameters for a node in its files; later files win."""
        found: dict[str, Setting] = {}
        shared = {place for _, place in self._shared(spec, at)}  # which need not be for each node
        for name, place in self._named(spec, at):
            path = self._path(name, place)
            if path not in self._files:
                self._files[path] = self._read(path, place)
            sections = self._files[path]
            if place.file not in self._problems.launch_files:
                self._strict.add(path)
            if place not in shared and sections and not any(s.fits(node) for s in sections):
                self._problems.add_unless_ros(
                    place, f"{name} has nothing for {node}{params_file.hint_for(sections, node)}"
                )
            settings = params_file.params_for(sections, node)
            if place.file in self._problems.launch_files:  # ROS ignores parameters that the node does not have
                settings = {n: replace(s, is_optional=True, is_unchecked=True) for n, s in settings.items()}
            found |= settings
        return found

    def checked(self, spec: NodeSpec, at: source.Path, node: str) -> tuple[str, ...]:
        """Return the parameter files of a program that reads them itself, once they are found valid."""
        found = [(self._path(name, place), place) for name, place in self._named(spec, at)]
        for path, place in found:
            if path not in self._files:
                self._files[path] = self._read(path, place)
            sections = self._files[path]
            if sections and not spec.keep_names and not any(section.fits(node) for section in sections):
                hint = params_file.hint_for(sections, node)
                self._problems.remark(place, f"{path.name} has nothing for {node}{hint}")
        return tuple(str(path) for path, _ in found if path.is_file())

    def _named(self, spec: NodeSpec, at: source.Path) -> list[tuple[str, Place]]:
        names = [spec.params_file] if isinstance(spec.params_file, str) else spec.params_file
        own = [(name, self._src.place((*at, "params_file", i))) for i, name in enumerate(names)]
        return [*self._shared(spec, at), *own]

    def _shared(self, spec: NodeSpec, at: source.Path) -> list[tuple[str, Place]]:
        """Return the files of the groups around a node, the outermost first."""
        at = (*at, f"params_file{FROM_GROUPS}")
        return [(name, self._src.place((*at, i))) for i, name in enumerate(spec.shared_params_file)]

    def _path(self, name: str, place: Place) -> Path:
        beside = self._graph_files[place.file].parent / name
        if place.file not in self._problems.launch_files:
            return beside
        here = Path(name).absolute()  # as ROS takes it
        return here if here.is_file() or (here.parent.is_dir() and not beside.is_file()) else beside

    def _read(self, path: Path, place: Place) -> list[Section]:
        if "$(" in str(path):  # a substitution that failed, which has been reported
            return []
        if not path.is_file():
            is_of_launch = place.file in self._problems.launch_files
            from graphflow.workspace.package_share import in_launch_file  # only after a mistake

            in_package = in_launch_file(path, self._graph_files[place.file]) if is_of_launch else ""
            self._problems.add_unless_ros(place, no_file(path, in_package))
            return []
        try:
            return params_file.read(path, shown(path), self._problems.remark)
        except GraphFileError as error:
            self._problems += error.problems
            return []

    def refuse_strays(self, nodes: list[str]) -> None:
        """Report sections for nodes that the graph does not have."""
        for sections in (self._files[path] for path in self._strict):
            self._problems += params_file.strays(sections, nodes)


def _nodes(
    src: Source, model: GraphFile, files: _ParamsFiles, programs: Programs, problems: Problems
) -> dict[str, PlannedNode]:
    """Return the nodes by full name."""
    nodes: dict[str, PlannedNode] = {}
    for name, spec in model.nodes.items():
        base: source.Path = ("nodes", name)
        command = programs.command(spec, base)
        if command is None:
            continue
        reads = files.checked(spec, base, name) if spec.exec_ else ()
        known = {} if spec.exec_ else files.params(spec, base, name)
        nodes[name] = PlannedNode(
            name=name,
            class_path="" if spec.class_ == NO_CLASS else spec.class_,
            command=command,
            executable=executable_of(spec),
            keeps_names=spec.keep_names,
            params_files=reads,
            place=src.key_place(base),
            class_place=src.place((*base, _what_it_is(spec))),
            params=known | _params(src, spec, base, problems),
            remaps=_remaps(src, spec, base, name, problems),
            process=spec.process,
            env={k: str(v) for k, v in spec.env.items()},
            after=spec.after,
            concurrency=_concurrency(src, spec.concurrency, (*base, "concurrency"), problems),
            restart=_restart(src, spec, base, problems),
            on_exit=spec.on_exit or "ignore",
            critical=bool(spec.critical),
            log_level=spec.log_level or "",
            lifecycle=spec.lifecycle or "",
            lifecycle_place=src.place((*base, "lifecycle")),
        )
    if not model.nodes and not problems and src.file not in problems.launch_files:
        problems.add(src.place(("nodes",)), f"there is no node{example('nodes')}")
    return nodes


def _what_it_is(spec: NodeSpec) -> str:
    """Return the key of a node that names what runs."""
    given = {"command": spec.command, "pkg": spec.pkg, "exec": spec.exec_}
    return next((key for key, value in given.items() if value), "class")


def _params(src: Source, spec: NodeSpec, base: source.Path, problems: Problems) -> dict[str, Setting]:
    """Return the parameters of a node; it need not declare those that come from its groups."""
    shared = params_file.flatten(src, spec.shared_params, (*base, f"params{FROM_GROUPS}"), problems)
    own = params_file.flatten(src, spec.params, (*base, "params"), problems)
    found = {name: replace(setting, is_optional=True) for name, setting in shared.items()} | own
    return {
        name: replace(s, is_optional=True, is_unchecked=True) if s.place.file in problems.launch_files else s
        for name, s in found.items()
    }


def _restart(src: Source, spec: NodeSpec, base: source.Path, problems: Problems) -> Backoff:
    given = spec.restart
    if spec.on_exit == "restart":
        if given is not None and given.policy != "always":
            text = f"on_exit: restart contradicts restart: {given.policy}; leave one of them out"
            problems.add(src.place((*base, "on_exit")), text)
        given = RestartSpec.model_validate({**(given.model_dump() if given else {}), "policy": "always"})
    if given is None:
        return BACKOFF
    numbers = (float(given.delay), float(given.max_delay), given.max_restarts, float(given.within))
    return Backoff(given.policy, *numbers)  # type: ignore[arg-type]  # one of the policies, by its validator


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


def _check_env(nodes: Iterable[PlannedNode], problems: Problems) -> None:
    """Report contradictory environments of nodes in one process."""
    seen: dict[tuple[str, str], tuple[str, str]] = {}
    for node in nodes:
        for name, value in node.env.items() if node.process else ():
            first, owner = seen.setdefault((node.process, name), (value, node.name))
            if first != value:
                text = f"{name}={value} contradicts {name}={first} of {owner}, which shares process {node.process!r}"
                problems.add(node.place, text)


def _remaps(src: Source, spec: NodeSpec, base: source.Path, node: str, problems: Problems) -> tuple[Rule, ...]:
    """Return a node's own remap rules, then those of its groups, which need not match."""
    namespace, name = split(node)
    rules: list[Rule] = []
    for key, remap in (("remap", spec.remap), (f"remap{FROM_GROUPS}", spec.shared_remap)):
        for match, replacement in remap.items():
            place = src.key_place((*base, key, match))
            try:
                if match.startswith("__"):
                    raise InvalidName(
                        f"{match!r} cannot be remapped; a node's name is its key, its namespace goes under namespace:"
                    )
                check_references(replacement, Resolver(name, namespace).pattern(match))
                # References such as \1 stand for parts that are not known yet; the rest must be a legal name.
                expand(re.sub(r"\\\d", "x", replacement), namespace, name)
            except InvalidName as error:
                problems.add(place, str(error))
                continue
            is_ros = place.file in problems.launch_files  # ROS ignores rules that match nothing
            rules.append(Rule(match, replacement, place, is_optional=is_ros or key != "remap", is_unchecked=is_ros))
    return tuple(rules)


_STEPS = {"call": "request", "set": "params", "goal": "request", "wait": "", "delay": "", "log": "", "shutdown": ""}
"""Kinds of steps, with the key of the data that they send."""


def _steps(src: Source, model: GraphFile, problems: Problems) -> list[PlannedStep]:
    steps = []
    for name, spec in model.steps.items():
        at: source.Path = ("steps", name)
        written = {"call": spec.call, "set": spec.set_, "goal": spec.goal, "wait": spec.wait, "log": spec.log}
        written["shutdown"] = spec.shutdown
        written["delay"] = "" if spec.delay is None else f"{spec.delay:g} s"
        kinds = [kind for kind, target in written.items() if target]
        if len(kinds) != 1:
            what = " and ".join(kinds) or "none of them"
            problems.add(src.key_place(at), f"a step has one of {', '.join(_STEPS)}; {name!r} has {what}")
            continue
        [kind] = kinds
        for key, value in (("request", spec.request), ("params", spec.params)):
            if value and key != _STEPS[kind]:
                problems.add(src.key_place((*at, key)), f"{key}: does not go with {kind}:{_goes_with(kind)}")
        key = _STEPS[kind] or kind
        sent = {n: s.value for n, s in params_file.flatten(src, spec.params, (*at, key), problems).items()}
        if kind == "set" and not sent:
            text = f"there is nothing to set; write params: {{NAME: VALUE}} beside set: {spec.set_}"
            problems.add(src.key_place(at), text)
        fields = (src.key_place((*at, key, field)) for field in spec.request)
        steps.append(
            PlannedStep(
                name=name,
                do=kind,  # type: ignore[arg-type]  # one of the keys above
                target=written[kind],
                place=src.key_place(at),
                target_place=src.place((*at, kind)),
                request=sent if kind == "set" else spec.request,
                request_place=src.place((*at, key)),
                field_places=dict(zip(spec.request, fields, strict=True)),
                type=spec.type,
                after=spec.after,
                timeout=float(spec.timeout if spec.delay is None else spec.delay),
            )
        )
    return steps


def _goes_with(kind: str) -> str:
    return f"; write {_STEPS[kind]}:" if _STEPS[kind] else ", which sends nothing"


def _names(names: str | list[str]) -> tuple[str, ...]:
    return (names,) if isinstance(names, str) else tuple(names)
