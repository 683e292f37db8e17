"""A graph file's blocks taken apart: what is left is a flat list of nodes and steps, each with its full name.

    include, group, for, if, unless, templates, $(...)   ->   nodes and steps

Every block adds to the `_Scope` that holds within it: values for substitutions, a namespace, and settings that its
nodes share. Files are taken in as they are reached, so that their names may have substitutions, too. Every value keeps
the place where it was written.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from graphflow.errors import GraphFileError, InvalidName, Place, Problem
from graphflow.graph.checks.validation import Problems, colon_fault, example, unknown_key, validated
from graphflow.graph.expansion.arguments import Arguments, behind_name
from graphflow.graph.expansion.inherit import BY_ENTRY, after_groups, with_groups
from graphflow.graph.expansion.loops import values_of
from graphflow.graph.expansion.ros_pairs import as_class
from graphflow.graph.model import (
    BLOCKS,
    TOP_KEYS,
    ForBlock,
    GroupBlock,
    IncludeBlock,
    NodeSpec,
    keys_of,
)
from graphflow.launchfiles.conversion import FROM_LAUNCH, ignore
from graphflow.launchfiles.reading import read
from graphflow.markup.substitution_words import misspelt
from graphflow.markup.substitutions import Outside, SubstitutionError, Substitutions, Written, truth
from graphflow.markup.tree import Item, located, merged, shared, source_of
from graphflow.names import check_full_name, check_namespace, did_you_mean, expand, join, split
from graphflow.workspace import executables
from graphflow.workspace.project import no_file, shown

MAX_ROUNDS = 10_000
"""Of all loops of a graph together."""
MAX_FILES = 200
MAX_MADE = 500_000
"""Values that a graph has once all is taken apart."""


@dataclass(frozen=True)
class _Scope:
    """What holds in a block."""

    values: Mapping[str, Any]
    """What `$(var ...)` stands for."""
    files: tuple[Path, ...]
    """The file, and before it those that include it."""
    namespace: str = "/"
    shared: tuple[Mapping[str, Item], ...] = ()
    """The settings of the groups around, the innermost first."""
    templates: Mapping[str, Item] = field(default_factory=dict)
    is_top: bool = True
    """Whether settings of the file are those of the graph."""


class Expansion:
    """A file and all that it includes, taken apart.

    Args:
        given: Words of the command line, `name:=value`.
        outside: What is around the file.
    """

    def __init__(self, given: Sequence[str], outside: Outside, problems: Problems) -> None:
        self.nodes: dict[str, Item] = {}
        """By full name."""
        self.steps: dict[str, Item] = {}
        self.settings: dict[str, Item] = {}
        """The other keys of the file, and of those that it includes whole."""
        self.written: dict[str, tuple[str, str]] = {}
        """The key of each node and step as its file has it, and the namespace in which it stands."""
        self.left_out: dict[str, Place] = {}
        """Nodes and steps that a condition has left out."""
        self.refused: set[str] = set()
        """Keys of nodes and steps whose names cannot be, which has been reported."""
        self.files: dict[str, Path] = {}
        """By the names that messages have for them."""
        self.arguments = Arguments(given, problems)
        self._outside, self._problems = outside, problems
        self._rounds = self._made = self._included = 0
        self._relative = 0
        """Names so far that depend on a namespace."""

    def whole(self, top: Item) -> Item:
        """All as one flat file."""
        nodes = top.entries.get("nodes", Item({}, top.place))._replace(value=self.nodes)
        return top._replace(value={"nodes": nodes, "steps": Item(self.steps, top.place), **self.settings})

    # files

    def file(self, top: Item, path: Path) -> None:
        """Take in the graph's own file."""
        self._file(top, path, _Scope({}, (path.resolve(),)), {})
        self.arguments.refuse_strays()

    def _file(self, top: Item, path: Path, scope: _Scope, fixed: Mapping[str, Item]) -> Mapping[str, Item]:
        """Take in a file; returns its templates."""
        self.files[top.place.file] = path.resolve()
        if (launch := top.entries.get(FROM_LAUNCH)) is not None:
            self._problems.launch_files.add(top.place.file)
        entries = top.without(FROM_LAUNCH).entries
        if entries.get("args") is None or isinstance(entries["args"].value, dict):
            outer = scope

            def substituted(item: Item, known: Mapping[str, Any]) -> Item:
                return self._substituted(item, replace(outer, values=known))

            texts = launch and launch.plain()
            values = self.arguments.of_file(entries.get("args"), scope.values, fixed, substituted, texts)
            scope = replace(scope, values=values)
        templates = entries.get("templates")
        if templates is not None:
            scope = replace(scope, templates={**scope.templates, **templates.entries})
        for key, item in entries.items():
            if key not in TOP_KEYS:
                self._problems.add(item.at, unknown_key(key, TOP_KEYS, item.plain()))
        overridden = entries.get("override")
        if overridden is not None and "include" not in entries:
            self._problems.add(overridden.at, "override: goes with include:, whose nodes it changes")
        elif overridden is not None and isinstance(entries["include"].value, list):
            self._problems.add(
                overridden.at, "override: with several files, write it at the one whose nodes it changes"
            )
        scope = self._body(entries, scope, overridden)
        if scope.is_top:
            self._take_settings(entries, scope)
        for key in ("nodes", "steps"):
            if key in entries and not isinstance(entries[key].value, (dict, type(None))):
                self.settings[key] = entries[key]  # its type is reported with those of the others
        return scope.templates

    def _take_settings(self, entries: Mapping[str, Item], scope: _Scope) -> None:
        """Keep what a file says of the whole graph, over what those that it includes say."""
        for key, item in entries.items():
            is_others = key == "name" and len(scope.files) > 1  # the graph is called as its own file says
            if key == "args" and isinstance(item.value, dict):
                self.settings[key] = merged(self.settings.get(key, Item({}, item.place)), item)
            elif key in TOP_KEYS and key not in (*BLOCKS, "templates", "override") and not is_others:
                self.settings[key] = item if key == "args" else self._substituted(item, scope)

    def _include(self, item: Item, scope: _Scope, overridden: Item | None = None) -> _Scope:
        """Take in other files; returns the scope with their templates."""
        if isinstance(item.value, list):
            for one in item.value:
                scope = self._include(one, scope)
            return scope
        block = Item({"file": item}, item.place) if isinstance(item.value, str) else item
        if self._is_left_out(block, scope):
            return scope
        block = self._substituted(block.without("if", "unless"), scope)
        model = self._checked(IncludeBlock, block)
        if model is None:
            return scope
        file = block.entries["file"]
        path = self.files[file.place.file].parent / model.file
        if path.resolve() in scope.files:
            self._problems.add(file.place, f"{model.file} includes itself")
            return scope
        top = self._read(path, file.place, {**scope.values, **model.args})
        if top is None:
            return scope
        before = set(self.nodes)
        inner = replace(
            scope,
            files=(*scope.files, path.resolve()),
            templates={},
            namespace=self._namespace(block, scope),
            is_top=scope.is_top and not block.entries.keys() & {"args", "namespace"},
        )
        templates = self._file(top, path, inner, block.entries["args"].entries if model.args else {})
        changes = [o for o in (block.entries.get("override"), overridden) if o is not None]
        for change in changes:
            self._override(self._substituted(change, scope), set(self.nodes) - before, scope)
        return replace(scope, templates={**templates, **scope.templates})

    def _read(self, path: Path, place: Place, values: Mapping[str, Any]) -> Item | None:
        if "$(" in str(path):  # which has been reported
            return None
        if not path.is_file():
            raise GraphFileError([*self._problems, Problem(place, behind_name(path.name) or no_file(path))])
        if len(self.files) > MAX_FILES:
            raise GraphFileError([Problem(place, f"more than {MAX_FILES} files are included")])
        self._included += 1
        found, told = self._problems, self._outside.describe
        number = self._included + 1
        top = read(path, shown(path), found.add, ignore, told, values, found.remark, number, found.leave_out)
        if not isinstance(top.value, dict):
            self._problems.add(place, f"{path.name} is not a graph file: it holds no mapping")
            return None
        return top

    def _override(self, changes: Item, included: set[str], scope: _Scope) -> None:
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
            elif self._is_left_out(change, scope):
                self.left_out[name] = change.at
                del self.nodes[name]
            else:
                changed = merged(self.nodes[name], change.without("if", "unless"), BY_ENTRY)
                self.nodes[name] = changed._replace(place=self.nodes[name].place, key=self.nodes[name].key)

    # blocks

    def _body(self, entries: Mapping[str, Item], scope: _Scope, overridden: Item | None = None) -> _Scope:
        """Take in what is in a file, group or loop; returns the scope with the templates of what it includes."""
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

    def _group(self, block: Item, scope: _Scope, what: str = "group") -> None:
        if self._is_left_out(block, scope):
            return
        settings = self._substituted(block.without("if", "unless", *BLOCKS), scope)
        bodies = {key: item for key, item in block.entries.items() if key in BLOCKS}
        if self._checked(GroupBlock, settings._replace(value={**settings.entries, **bodies}), block) is None:
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
        before = self._relative
        self._body(bodies, inner)
        if "namespace" in settings.entries and self._relative == before and inner.namespace != scope.namespace:
            text = "every name in this group begins with a slash, so the namespace has no effect; leave the slashes out"
            self._problems.add_unless_ros(settings.entries["namespace"].place, text)

    def _for(self, block: Item, scope: _Scope) -> None:
        if self._is_left_out(block, scope):
            return
        entries = block.entries
        if not isinstance(block.value, dict) or not {"var", "in"} <= entries.keys():
            self._checked(ForBlock, block)
            return
        name, over = entries["var"], self._substituted(entries["in"], scope)
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

    def _namespace(self, settings: Item, scope: _Scope) -> str:
        """The namespace in a block that may have one of its own."""
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

    def _node(self, written: str, item: Item, scope: _Scope) -> None:
        key = str(self._one(written, item.at, scope))
        whole = self._from_template(item, scope)
        if whole is None:
            self.refused.add(key)
            return
        item = whole
        if "keep_names" in item.entries and item.at.file in self._problems.launch_files:
            key, item = self._named(key, item, scope)
        own = item.entries.get("namespace")
        own = own and self._substituted(own, scope)
        name = self._full_name(key, item, own, scope)
        if name is None:
            self.refused.add(key)
            return
        if self._is_left_out(item, scope):
            self.left_out[name] = item.at
            return
        if name in self.nodes and (item.at.file in self._problems.launch_files or "keep_names" in item.entries):
            taken, name = name, next(free for n in count(2) if (free := f"{name}_{n}") not in self.nodes)
            if not item.entries.keys() & {"keep_names", "command"}:  # else the name is that of the process alone
                self._problems.add_unless_ros(item.at, f"there is a node {taken} already; this one is called {name}")
        if self._is_taken(name, item, self.nodes, "nodes"):
            return
        with self._problems.of_node(name):
            item = self._substituted(item.without("if", "unless", "template", "namespace"), scope, ("args", "command"))
        if own is not None and not isinstance(own.value, str):
            item = item._replace(value={**item.entries, "namespace": own})
        if isinstance(item.value, dict):
            item = with_groups(as_class(item, self._outside.root), scope.shared)
        self.nodes[name] = item
        self.written[name] = (key, scope.namespace)

    def _named(self, key: str, item: Item, scope: _Scope) -> tuple[str, Item]:
        """An executable of a launch file with its name, where it is only known now which it is."""
        words = {k: item.entries[k] for k in ("pkg", "exec") if k in item.entries}
        if not any("$(" in str(word.value) for word in words.values()) or self._is_left_out(item, scope):
            return key, item
        item = item._replace(value={**item.value, **{k: self._substituted(word, scope) for k, word in words.items()}})
        package, name = (str(item.entries[k].value) if k in words else "" for k in ("pkg", "exec"))
        found = executables.find(package, name, self._outside.root)
        if found is None:
            return executables.as_name(name), item
        return found.node_name, item.without("keep_names")

    def _full_name(self, key: str, item: Item, own: Item | None, scope: _Scope) -> str | None:
        namespace = own.value if own is not None and isinstance(own.value, str) else ""
        if key.startswith("/") and namespace:
            short = split(key)[1]
            text = f"{key} is a full name, so a namespace would have no effect; name the node {short}, or remove this"
            self._problems.add(own.place if own else item.at, text)
        if colon := colon_fault(key):
            self._problems.add(item.place, colon)
            return None
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

    def _step(self, written: str, item: Item, scope: _Scope) -> None:
        name = str(self._one(written, item.at, scope))
        if self._is_left_out(item, scope):
            self.left_out[name] = item.at
            return
        if self._is_taken(name, item, self.steps, "steps"):
            return
        item = after_groups(self._substituted(item.without("if", "unless"), scope), scope.shared)
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
            item = item._replace(value={**item.entries, key: target._replace(value=full)})
        self.steps[name] = item
        self.written[name] = (name, scope.namespace)

    def _is_taken(self, name: str, item: Item, those: Mapping[str, Item], what: str) -> bool:
        if name not in those:
            return False
        first = those[name].at
        if first.file != item.at.file:
            if what == "nodes":
                text = f"{name} is already in the included file; change it under override:"
            else:
                text = f"there is a step {name!r} already, at {first}; give this one another name"
        elif first == item.at:
            text = f"every round of the loop has the same {what[:-1]} {name}; put the loop's variable into its name"
        else:
            text = f"there are two {what} {name}; the other is on line {first.line}"
        self._problems.add(item.at, text)
        return True

    def _from_template(self, item: Item, scope: _Scope) -> Item | None:
        """A node with what its template has; None, with a problem added, if there is no such template."""
        wanted = item.entries.get("template")
        if wanted is None:
            return item
        name = self._substituted(wanted, scope).value
        base = scope.templates.get(name) if isinstance(name, str) else None
        if base is None:
            near = did_you_mean(str(name), scope.templates) or "; the file has none under templates:"
            self._problems.add(wanted.place, f"there is no template {name!r}{near}")
            return None
        if not isinstance(base.value, dict):
            self._problems.add(base.place, f"templates.{name}: expected a mapping, as for a node, got {base.plain()!r}")
            return None
        for key, entry in base.entries.items():
            if key == "template":
                self._problems.add(entry.at, "a template cannot use a template; write here what it has")
            elif key not in keys_of(NodeSpec):
                self._problems.add(entry.at, unknown_key(key, keys_of(NodeSpec)))
        return merged(base, item, BY_ENTRY)

    # values

    def _is_left_out(self, item: Item, scope: _Scope) -> bool:
        """Whether a block's condition leaves it out."""
        left_out = False
        for key, wanted in (("if", True), ("unless", False)):
            condition = item.entries.get(key)
            if condition is None:
                continue
            try:
                value = self._one(condition.value, condition.place, scope)
                left_out |= truth(value, condition.place.file) is not wanted
            except SubstitutionError as error:
                self._problems.add_unknown(condition.place, f"{key}: {error}")
        return left_out

    def _one(self, value: Any, place: Place, scope: _Scope, *, is_word: bool = False) -> Any:
        if not isinstance(value, str):
            return value
        if not is_word and place.file not in self._problems.launch_files:
            for written, name in misspelt(value, scope.values):
                self._problems.remark(place, f"{written} stays as it is; for the value of {name!r} write $(var {name})")
        if "$(" not in value:
            return value
        file = self.files.get(place.file, Path())
        params = shared("params", scope.shared) if "param" in value else {}
        variables = {name: str(text) for name, text in shared("env", scope.shared).items()}
        outside = self._outside._replace(env={**self._outside.env, **variables})
        try:
            return Substitutions(scope.values, file, outside, params).apply(value, is_word=is_word)
        except SubstitutionError as error:
            self._problems.add_unknown(place, str(error))
            return value

    def _substituted(self, item: Item, scope: _Scope, words: Collection[str] = (), *, is_word: bool = False) -> Item:
        """The same with every substitution made, in keys too; `words` are keys of lists of texts."""
        if isinstance(item.value, dict):
            result: dict[str, Item] = {}
            for key, inner in item.value.items():
                name = str(self._one(key, inner.at, scope))
                if name in result:
                    self._problems.add(inner.at, f"the key {key!r} becomes {name!r}, which is already here")
                result[name] = self._substituted(inner, scope, is_word=name in words)
            return item._replace(value=result)
        if isinstance(item.value, list):
            return item._replace(value=[self._substituted(inner, scope, is_word=is_word) for inner in item.value])
        is_written = isinstance(item.value, Written)
        value = self._one(item.value, item.place, scope, is_word=is_word or is_written)
        value = Written(value) if is_written else value
        self._count(value, item.place)
        return located(value, item.place)._replace(key=item.key)

    def _count(self, value: Any, place: Place) -> None:
        """Count what loops and arguments make of a file, which could be more than any memory holds."""
        todo = [value]
        while todo:
            value = todo.pop()
            self._made += 1
            if self._made > MAX_MADE:
                raise GraphFileError([Problem(place, f"loops and arguments make more than {MAX_MADE:,} values of it")])
            if isinstance(value, (list, dict)):
                todo += value.values() if isinstance(value, dict) else value

    def _checked(self, model: type[BaseModel], block: Item, whole: Item | None = None) -> Any:
        """The model of a block; None, with problems added, where its keys or types are wrong."""
        if not isinstance((whole or block).value, (dict, str)):
            what = {IncludeBlock: "include", ForBlock: "for"}.get(model, "group")
            text = f"{what}: expected a mapping, got {(whole or block).plain()!r}{example(what)}"
            self._problems.add((whole or block).place, text)
            return None
        return validated(model, source_of(block), self._problems)
