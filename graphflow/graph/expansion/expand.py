"""Expansion of a graph file's blocks to a flat list of nodes and steps, each with its full name.

    include, group, for, if, unless, templates, $(...)   ->   nodes and steps

Every block extends the `Scope` of its content: values for substitutions, a namespace, and settings that its nodes
share. Files are read when they are reached, so that their names may have substitutions, too. Every value keeps its
place.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path

from pydantic import BaseModel

from graphflow.errors import GraphFileError, InvalidName, Place, Problem
from graphflow.graph.checks.parameter_slips import remark_on_texts
from graphflow.graph.checks.taken_names import taken
from graphflow.graph.checks.validation import M, Problems, colon_fault, example, unknown_key, validated
from graphflow.graph.expansion.arguments import Arguments, arguments_after_name
from graphflow.graph.expansion.inherit import BY_ENTRY, after_groups, from_template, with_groups
from graphflow.graph.expansion.loops import values_of
from graphflow.graph.expansion.ros_pairs import as_class
from graphflow.graph.expansion.values import Scope, Values
from graphflow.graph.model import (
    BLOCKS,
    TOP_KEYS,
    ForBlock,
    GroupBlock,
    IncludeBlock,
)
from graphflow.launchfiles.conversion import FROM_LAUNCH
from graphflow.launchfiles.reading import read
from graphflow.launchfiles.recorded import Describe
from graphflow.markup.source import Data
from graphflow.markup.substitutions import Outside
from graphflow.markup.tree import Item, merged, source_of
from graphflow.names import check_full_name, check_namespace, did_you_mean, expand, join, split
from graphflow.workspace import executables
from graphflow.workspace.project import no_file, shown

_TEXTS = ("env", "log", "shutdown")
"""Keys of groups, nodes and steps whose values are texts, be it the text of a number."""
MAX_ROUNDS = 10_000
"""Rounds of all loops of a graph together."""
MAX_FILES = 200


class Expansion:
    """The expansion of a file and the files that it includes.

    Args:
        given: Arguments from the command line, `name:=value`.
        outside: The file's environment.
        describe: Runs launch files in Python; they are refused without.
    """

    def __init__(
        self, given: Sequence[str], outside: Outside, problems: Problems, describe: Describe | None = None
    ) -> None:
        self.nodes: dict[str, Item] = {}
        """Nodes by full name."""
        self.steps: dict[str, Item] = {}
        self.settings: dict[str, Item] = {}
        """The other entries of the file, and of the files included at its top level."""
        self.written: dict[str, tuple[str, str]] = {}
        """The key of each node and step in its file, and the namespace around it."""
        self.left_out: dict[str, Place] = {}
        """Nodes and steps left out by a condition."""
        self.refused: set[str] = set()
        """Keys of nodes and steps with invalid names, which have been reported."""
        self.files: dict[str, Path] = {}
        """The graph files, by the names that messages have for them."""
        self.tops: dict[str, Item] = {}
        """The contents of these files."""
        self.followed: set[Place] = set()
        """Places of the includes whose files are among these."""
        self.arguments = Arguments(given, problems)
        self._outside, self._problems, self._describe = outside, problems, describe
        self._values = Values(outside, self.files, problems)
        self._rounds = self._included = 0
        self._relative = 0
        """Number of names so far that depend on a namespace."""

    def whole(self, top: Item) -> Item:
        """Return the whole graph as one flat file."""
        nodes = top.entries.get("nodes", Item({}, top.place)).with_value(self.nodes)
        return top.with_value({"nodes": nodes, "steps": Item(self.steps, top.place), **self.settings})

    # files

    def file(self, top: Item, path: Path) -> None:
        """Expand the graph's own file."""
        self._file(top, path, Scope({}, (path.resolve(),)), {})
        self.arguments.refuse_strays()

    def _file(self, top: Item, path: Path, scope: Scope, fixed: Mapping[str, Item]) -> Mapping[str, Item]:
        """Expand a file; returns its templates."""
        self.files[top.place.file] = path.resolve()
        self.tops[top.place.file] = top
        if (launch := top.entries.get(FROM_LAUNCH)) is not None:
            self._problems.launch_files.add(top.place.file)
        entries = top.without(FROM_LAUNCH).entries
        if entries.get("args") is None or isinstance(entries["args"].value, dict):
            outer = scope

            def substituted(item: Item, known: Mapping[str, Data]) -> Item:
                return self._values.substituted(item, replace(outer, values=known), is_text=launch is not None)

            texts = None if launch is None else {name: str(text.value) for name, text in launch.entries.items()}
            values = self.arguments.of_file(entries.get("args"), scope.values, fixed, substituted, texts)
            scope = replace(scope, values=values)
        templates = entries.get("templates")
        if templates is not None:
            scope = replace(scope, templates={**scope.templates, **templates.entries})
        overridden = entries.get("override")
        self._check_keys(entries)
        scope = self._body(entries, scope, overridden)
        if scope.is_top:
            self._take_settings(entries, scope)
        for key in ("nodes", "steps"):
            if key in entries and not isinstance(entries[key].value, (dict, type(None))):
                self.settings[key] = entries[key]  # its type is reported with those of the others
        return scope.templates

    def _check_keys(self, entries: Mapping[str, Item]) -> None:
        """Report unknown keys of a file, and an `override` that it cannot have."""
        for key, item in entries.items():
            if key not in TOP_KEYS:
                self._problems.add(item.at, unknown_key(key, TOP_KEYS, item.plain()))
        overridden = entries.get("override")
        if overridden is not None and "include" not in entries:
            self._problems.add(overridden.at, "override: goes with include:, whose nodes it changes")
        elif overridden is not None and isinstance(entries["include"].value, list):
            way = "write it at the one whose nodes it changes, as in - {file: FILE, override: ...}"
            self._problems.add(overridden.at, f"override: with a list of files, {way}")

    def _take_settings(self, entries: Mapping[str, Item], scope: Scope) -> None:
        """Keep a file's settings of the whole graph, which replace those of the files that it includes."""
        for key, item in entries.items():
            is_others = key == "name" and len(scope.files) > 1  # only its own file names a graph
            if key == "args" and isinstance(item.value, dict):
                self.settings[key] = merged(self.settings.get(key, Item({}, item.place)), item)
            elif key in TOP_KEYS and key not in (*BLOCKS, "templates", "override") and not is_others:
                self.settings[key] = (
                    item if key == "args" else self._values.substituted(item, scope, is_text=key in _TEXTS)
                )

    def _include(self, item: Item, scope: Scope, overridden: Item | None = None) -> Scope:
        """Include files; returns the scope with their templates."""
        if isinstance(item.value, list):
            for one in item.value:
                scope = self._include(one, scope)
            return scope
        block = Item({"file": item}, item.place) if isinstance(item.value, str) else item
        if self._values.is_left_out(block, scope):
            return scope
        block = self._values.substituted(block.without("if", "unless"), scope)
        model = self._checked(IncludeBlock, block)
        if model is None:
            return scope
        file = block.entries["file"]
        path = self.files[file.place.file].parent / model.file
        if path.resolve() in scope.files:
            self._problems.add(file.place, f"{model.file} includes itself")
            return scope
        values: dict[str, object] = {**scope.values, **model.args}
        top = self._read(path, file.place, values)
        if top is None:
            return scope
        self.followed.add(item.place)
        before = set(self.nodes)  # overrides may change only the nodes of this file
        inner = replace(
            scope,
            files=(*scope.files, path.resolve()),
            templates={},
            namespace=self._namespace(block, scope),
            is_top=scope.is_top and not block.entries.keys() & {"args", "namespace"},
        )
        relative = self._relative  # unchanged afterwards if no name in the file depends on a namespace
        templates = self._file(top, path, inner, block.entries["args"].entries if model.args else {})
        is_in_vain = inner.namespace != scope.namespace and self._relative == relative and self.nodes.keys() - before
        if is_in_vain and "namespace" in block.entries:
            text = f"every name in {model.file} begins with a slash, so the namespace has no effect; leave it out there"
            self._problems.add_unless_ros(block.entries["namespace"].place, text)
        changes = [o for o in (block.entries.get("override"), overridden) if o is not None]
        for change in changes:
            self._override(self._values.substituted(change, scope), set(self.nodes) - before, scope)
        # Templates of the including file have precedence over those of the included one.
        return replace(scope, templates={**templates, **scope.templates})

    def _read(self, path: Path, place: Place, values: Mapping[str, object]) -> Item | None:
        if "$(" in str(path):  # a substitution that failed, which has been reported
            return None
        if not path.is_file():
            raise GraphFileError([*self._problems, Problem(place, arguments_after_name(path.name) or no_file(path))])
        if len(self.files) > MAX_FILES:
            raise GraphFileError([Problem(place, f"more than {MAX_FILES} files are included")])
        self._included += 1
        problems = self._problems
        top = read(
            path,
            shown(path),
            problems.add,
            describe=self._describe,
            values=values,
            remark=problems.remark,
            number=self._included + 1,
            leave_out=problems.leave_out,
        )
        if not isinstance(top.value, dict):
            self._problems.add(place, f"{path.name} is not a graph file: it holds no mapping")
            return None
        return top

    def _override(self, changes: Item, included: set[str], scope: Scope) -> None:
        """Change nodes of an included file."""
        by_key = {self.written[name][0]: name for name in included}
        if not isinstance(changes.value, dict):
            self.settings["override"] = changes  # its type is reported with those of the others
            return
        for key, change in changes.entries.items():
            name = key if key in included else by_key.get(key, "")
            if not name:
                near = did_you_mean(key, [*by_key, *included])
                self._problems.add(change.at, f"the included file has no node {key!r}{near}")
            elif not isinstance(change.value, dict):
                self._problems.add(change.place, f"{key}: expected a mapping of what differs, got {change.plain()!r}")
            elif self._values.is_left_out(change, scope):
                self.left_out[name] = change.at
                del self.nodes[name]
            else:
                changed = merged(self.nodes[name], change.without("if", "unless"), BY_ENTRY)
                self.nodes[name] = self.nodes[name].with_value(changed.value)

    # blocks

    def _body(self, entries: Mapping[str, Item], scope: Scope, overridden: Item | None = None) -> Scope:
        """Expand the body of a file, group or loop; returns the scope with the templates of included files."""
        if "include" in entries and entries["include"].value is not None:
            scope = self._include(entries["include"], scope, overridden)
        for key, item in entries.items():
            if key == "nodes":
                for name, node in item.entries.items():
                    self._node(name, node, scope)
            elif key == "steps":
                for name, step in item.entries.items():
                    self._step(name, step, scope)
            elif key in ("group", "for"):
                for block in item.value if isinstance(item.value, list) else [item]:
                    if block.value is not None:
                        self._group(block, scope) if key == "group" else self._for(block, scope)
        return scope

    def _group(self, block: Item, scope: Scope, what: str = "group") -> None:
        if self._values.is_left_out(block, scope):
            return
        settings = self._values.substituted(block.without("if", "unless", *BLOCKS), scope, texts=_TEXTS)
        bodies = {key: item for key, item in block.entries.items() if key in BLOCKS}
        if self._checked(GroupBlock, settings.with_value({**settings.entries, **bodies}), block) is None:
            return
        inner = replace(
            scope,
            namespace=self._namespace(settings, scope),
            shared=(settings.entries, *scope.shared),
            is_top=False,
        )
        if not bodies and block.at.file not in self._problems.launch_files:
            self._problems.add(block.at, f"the {what} has no nodes; indent nodes: below it")
            return
        before = self._relative  # unchanged afterwards if no name in the group depends on a namespace
        self._body(bodies, inner)
        if "namespace" in settings.entries and self._relative == before and inner.namespace != scope.namespace:
            text = "every name in this group begins with a slash, so the namespace has no effect; leave the slashes out"
            if not bodies:
                text = "a namespace holds for the actions that follow it; put it before them"
            self._problems.add_unless_ros(settings.entries["namespace"].place, text)

    def _for(self, block: Item, scope: Scope) -> None:
        if self._values.is_left_out(block, scope):
            return
        entries = block.entries
        if not isinstance(block.value, dict) or not {"var", "in"} <= entries.keys():
            self._checked(ForBlock, block)
            return
        name, over = entries["var"], self._values.substituted(entries["in"], scope)
        if not isinstance(name.value, str) or not name.value.isidentifier():
            self._problems.add(name.place, f"var: expected a name for the loop's values, got {name.plain()!r}")
            return
        body = block.without("var", "in", "if", "unless")
        is_written_out = over.plain() == entries["in"].plain()
        for value in values_of(over, self._problems, is_written_out=is_written_out):
            self._rounds += 1
            if self._rounds > MAX_ROUNDS:
                raise GraphFileError([Problem(over.place, f"the loops have more than {MAX_ROUNDS:,} rounds")])
            self._group(body, replace(scope, values={**scope.values, name.value: value}), "loop")

    def _namespace(self, settings: Item, scope: Scope) -> str:
        """Return the namespace within a block."""
        item = settings.entries.get("namespace")
        if item is None or not isinstance(item.value, str) or not item.value:
            return scope.namespace
        try:
            if item.value.startswith("/"):
                return check_namespace(item.value)
            self._relative += 1
            return check_namespace(join(scope.namespace, item.value))
        except InvalidName as error:
            self._problems.add(item.place, str(error))
            return scope.namespace

    # nodes and steps

    def _node(self, written: str, item: Item, scope: Scope) -> None:
        key = str(self._values.made(written, item.at, scope))
        whole = self._from_template(item, scope)
        if whole is None:
            self.refused.add(key)
            return
        item = whole
        if "keep_names" in item.entries and item.at.file in self._problems.launch_files:
            key, item = self._named(key, item, scope)
        own = item.entries.get("namespace")
        own = own and self._values.substituted(own, scope)
        name = self._full_name(key, item, own, scope)
        if name is None:
            self.refused.add(key)
            return
        if self._values.is_left_out(item, scope):
            self.left_out[name] = item.at
            return
        # ROS starts two nodes of one name, as a launch file may have by mistake; here the second gets another name.
        if name in self.nodes and (item.at.file in self._problems.launch_files or "keep_names" in item.entries):
            taken, name = name, next(free for n in count(2) if (free := f"{name}_{n}") not in self.nodes)
            if not item.entries.keys() & {"keep_names", "command"}:  # else the name is that of the process alone
                self._problems.add_unless_ros(item.at, f"there is a node {taken} already; this one is called {name}")
        if self._is_taken(name, item, scope, self.nodes, "nodes"):
            return
        remark_on_texts(item.entries.get("params"), scope.values, self._problems.remark)
        with self._problems.of_node(name):
            item = self._values.substituted(
                item.without("if", "unless", "template", "namespace"), scope, ("args", "command"), _TEXTS
            )
        if own is not None and not isinstance(own.value, str):
            item = item.with_value({**item.entries, "namespace": own})
        if isinstance(item.value, dict):
            item = with_groups(as_class(item, self._outside.root), scope.shared)
        self.nodes[name] = item
        self.written[name] = (key, scope.namespace)

    def _named(self, key: str, item: Item, scope: Scope) -> tuple[str, Item]:
        """Return an executable of a launch file with its name, which a substitution may determine only now."""
        words = {k: item.entries[k] for k in ("pkg", "exec") if k in item.entries}
        if not any("$(" in str(word.value) for word in words.values()) or self._values.is_left_out(item, scope):
            return key, item
        item = item.with_value(
            {**item.entries, **{k: self._values.substituted(word, scope) for k, word in words.items()}}
        )
        package, name = (str(item.entries[k].value) if k in words else "" for k in ("pkg", "exec"))
        found = executables.find(package, name, self._outside.root)
        if found is None:
            return executables.as_name(name), item
        return found.node_name, item.without("keep_names")

    def _full_name(self, key: str, item: Item, own: Item | None, scope: Scope) -> str | None:
        namespace = own.value if own is not None and isinstance(own.value, str) else ""
        if key.startswith("/") and namespace:
            short = split(key)[1]
            text = f"{key} is a full name, so a namespace would have no effect; name the node {short}, or remove this"
            self._problems.add(own.place if own else item.at, text)
        if colon := colon_fault(key):
            self._problems.add(item.place, colon)
            return None
        self._remark_on_slash(key, item)
        self._relative += not key.startswith("/") and not namespace.startswith("/")
        try:
            around = check_namespace(join(scope.namespace, namespace)) if namespace else scope.namespace
        except InvalidName as error:
            self._problems.add(own.place if own else item.at, str(error))
            return None
        try:
            return check_full_name(join(around, key), "node name")
        except InvalidName as error:
            self._problems.add(item.at, str(error))
            return None

    def _remark_on_slash(self, key: str, item: Item) -> None:
        """Remark on a name of a launch file that is a path, which only graph files may have."""
        if "/" in key and item.at.file in self._problems.launch_files:
            above, short = split(key if key.startswith("/") else f"/{key}")
            text = f"ROS 2 takes no / in a node's name: write name {short!r}, and namespace {above.strip('/')!r}"
            self._problems.remark(item.at, text)

    def _step(self, written: str, item: Item, scope: Scope) -> None:
        name = str(self._values.made(written, item.at, scope))
        if self._values.is_left_out(item, scope):
            self.left_out[name] = item.at
            return
        if self._is_taken(name, item, scope, self.steps, "steps"):
            return
        item = after_groups(self._values.substituted(item.without("if", "unless"), scope, texts=_TEXTS), scope.shared)
        for key in ("call", "set", "goal", "wait"):
            target = item.entries.get(key)
            if target is None or not isinstance(target.value, str):
                continue
            self._relative += not target.value.startswith("/")
            try:
                full = expand(target.value, scope.namespace, "graph")
            except InvalidName as error:
                self._problems.add(target.place, str(error))
                self.refused.add(name)
                return
            item = item.with_value({**item.entries, key: target.with_value(full)})
        self.steps[name] = item
        self.written[name] = (name, scope.namespace)

    def _is_taken(self, name: str, item: Item, scope: Scope, those: Mapping[str, Item], what: str) -> bool:
        if name not in those:
            return False
        is_absolute = scope.namespace != "/" and self.written[name][0].startswith("/")
        text = taken(name, what, item.at, those[name].at, is_included=len(scope.files) > 1, is_absolute=is_absolute)
        self._problems.add(item.at, text)
        return True

    def _from_template(self, item: Item, scope: Scope) -> Item | None:
        """Merge a node with its template; None, with a problem added, if there is no such template."""
        wanted = item.entries.get("template")
        if wanted is None:
            return item
        name = self._values.substituted(wanted, scope).plain()
        return from_template(item, wanted.place, name, scope.templates, self._problems)

    def _checked(self, model: type[M], block: Item, whole: Item | None = None) -> M | None:
        """Validate a block; None, with problems added, if its keys or types are wrong."""
        if not isinstance((whole or block).value, (dict, str)):
            names: dict[type[BaseModel], str] = {IncludeBlock: "include", ForBlock: "for"}
            what = names.get(model, "group")
            text = f"{what}: expected a mapping, got {(whole or block).plain()!r}{example(what)}"
            self._problems.add((whole or block).place, text)
            return None
        return validated(model, source_of(block), self._problems)
