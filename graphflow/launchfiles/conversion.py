"""Conversion of ROS's launch files, as trees of the YAML dialect, to graph files.

    launch:                                              nodes:
    - arg: {name: rate, default: "2.0"}                    /lab/talker:
    - group:                                                 class: nodes.talker:Talker
      - push_ros_namespace: {namespace: lab}       ->        params: {rate: $(var rate)}
      - node: {pkg: demo_nodes_py, exec: talker,         (and args: {rate: {default: 2.0}})
               param: [{name: rate, value: $(var rate)}]}

An action that sets something for all later actions (a namespace, a parameter, a remap, a variable) becomes a group
around them. Every value keeps its place. An action that a graph file cannot express is reported with its line.

Source: launch and launch_ros, the parsers of their frontends; the design articles on launch XML and YAML.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from graphflow.errors import Place
from graphflow.launchfiles.attributes import children, has_value, split
from graphflow.launchfiles.attributes import words as words_of
from graphflow.launchfiles.bodies import add, extend, put
from graphflow.launchfiles.commands import one_word_fault, plain_words, step_of, typed
from graphflow.launchfiles.components import KNOWN, components
from graphflow.launchfiles.known_actions import CONDITIONS, FORMER, RECORDED, SAME, is_known, no_action
from graphflow.launchfiles.recorded import Action
from graphflow.launchfiles.settings import as_text, conditional, conditions, pair, params, ros_arguments, setting
from graphflow.markup.source import Complain, Data, Scalar
from graphflow.markup.tree import Item, items, located
from graphflow.workspace import executables
from graphflow.workspace.packages import bundled, find_workspace

FROM_LAUNCH = "from a launch file"
"""The key that marks a graph file as converted from a launch file, in which ROS's laxer rules apply."""

PATIENCE = 60.0
"""Timeout in seconds of a `ros2` command that becomes a step; ROS's own would wait for a server for ever."""
_SCOPING = (
    *("push_ros_namespace", "set_parameter", "set_parameters_from_file", "set_remap", "set_use_sim_time"),
    *("set_env", "append_env", "let"),
)


def is_launch_file(top: Item) -> bool:
    """Return whether a file is a launch file in ROS's dialect."""
    return "launch" in top.entries and isinstance(top.entries["launch"].value, list)


def ignore(place: Place, text: str) -> None:
    """Discard a message."""


def recorded(actions: Iterable[Mapping[str, Data]], file: str) -> Item:
    """Convert the actions recorded from a launch file in Python to a tree of the YAML dialect.

    Args:
        actions: As `Action.to_json` makes them.
    """

    def item(action: Action) -> Item:
        place = Place(file, action.line, 1)
        entries = located({**action.attributes, **action.relations()}, place).entries
        if action.children is not None:
            entries["children"] = Item([item(child) for child in action.children], place)
        return Item({action.name: Item(entries, place, place)}, place)

    top = Place(file, 1, 1)
    return Item({"launch": Item([item(Action.from_json(action)) for action in actions], top)}, top)


def native(
    top: Item,
    root: Path,
    complain: Complain,
    note: Complain = ignore,
    number: int = 1,
    leave_out: Complain = ignore,
) -> Item:
    """Convert a launch file to a graph file.

    Args:
        top: The file: a list of actions under `launch`.
        root: The project's folder.
        complain: Called with each part that a graph file cannot express.
        note: Called with remarks on parts that it can express.
        number: The position of the file among those of the graph, which makes names of steps unique.
        leave_out: Called with components that are not installed.
    """
    return _Translation(root, complain, note, number, leave_out).file(top)


class _Translation:
    """The conversion of one file."""

    def __init__(self, root: Path, complain: Complain, note: Complain, number: int, leave_out: Complain) -> None:
        self._root, self._complain, self._note, self._leave_out = root, complain, note, leave_out
        self._of = f"_of_{number}" if number > 1 else ""
        self._args: dict[str, Item] = {}
        self._texts: dict[str, Item] = {}
        """Defaults of the arguments as texts, by name."""
        self._count: dict[str, int] = {}
        self._numbered: dict[Scalar, tuple[str, bool]] = {}
        """The names of actions that others come after, by number, and whether they are steps."""
        self._converters: dict[str, Callable[[Item, dict[str, Item]], None]] = {
            "arg": self._arg,
            "node": self._node,
            **dict.fromkeys(KNOWN, self._container),
            "executable": self._executable,
            "log": self._log,
            "shutdown": self._shutdown,
            "include": self._include,
            "group": self._group,
            "timer": self._timer,
        }
        """Methods that add an action to a body, by the action's name."""

    def file(self, top: Item) -> Item:
        body = self._block(top.entries["launch"].items)
        args = {"args": Item(self._args, top.place)} if self._args else {}
        return top.with_value({FROM_LAUNCH: Item(self._texts, top.place), **args, **body})

    # lists of actions

    def _block(self, actions: list[Item]) -> dict[str, Item]:
        """Convert a list of actions to the body of a file or group."""
        body: dict[str, Item] = {}
        for i, action in enumerate(actions):
            if not isinstance(action.value, dict) or len(action.value) != 1:
                self._complain(action.place, no_action(action))
                continue
            [(written, item)] = action.entries.items()
            name = SAME.get(written, written)
            item = item.with_key(item.key or action.place)
            if name == "group" and isinstance(item.value, list):
                item = item.with_value({"children": item})
            if not is_known(name, item, self._complain):
                continue
            after = actions[i + 1 :]
            if name in _SCOPING:
                # The group contains all later actions, so nothing is left to convert here.
                add(body, "group", self._around(name, item, after))
                break
            if name == "group" and has_value(item, "scoped", "false", "0") and _sets_anything(item):
                # The settings of a group that is not scoped hold for later actions, too.
                for key, more in self._block([*self._each_if(item), *after]).items():
                    extend(body, key, more)
                break
            self._converters[name](item, body)
        return body

    def _around(self, name: str, item: Item, after: list[Item]) -> Item:
        """Convert an action that sets something for all later actions to a group around them."""
        if self._conditions(item) and name not in ("let", "push_ros_namespace"):
            self._complain(item.at, f"{name}: a condition here has no equivalent in a graph file; put it on a group")
        nothing = Item("", item.place)
        if name == "let":
            variable = item.entries.get("name", nothing)
            # If the condition does not hold, the variable keeps its former value.
            value = conditional(item, item.entries.get("value", nothing), f"$(var {variable.value} '')")
            # A loop over one value binds the variable for all later actions.
            loop = {"var": variable, "in": Item([as_text(value)], item.place), **self._block(after)}
            return item.with_value({"for": Item(loop, item.place)})
        key, value = setting(name, item, self._complain)
        rest = self._block(after)
        inner = rest.get("group")
        if inner is not None and len(rest) == 1 and isinstance(inner.value, dict) and key not in inner.value:
            rest = inner.value  # one group for both settings
        return item.with_value({key: value, **rest})

    # actions

    def _log(self, item: Item, body: dict[str, Item]) -> None:
        message = item.entries.get("message", Item("", item.place))
        if message.value:
            self._add_step(body, "log", item, {"log": message})

    def _shutdown(self, item: Item, body: dict[str, Item]) -> None:
        reason = item.entries.get("reason", Item("requested by a launch file", item.place))
        self._add_step(body, "shutdown", item, {"shutdown": reason})

    def _container(self, item: Item, body: dict[str, Item]) -> None:
        for component in components(item, self._root, self._complain, self._leave_out):
            self._node(component, body)

    def _group(self, item: Item, body: dict[str, Item]) -> None:
        inner = self._block(children(item))
        conditions = self._conditions(item)
        only = inner.get("group")
        if only is not None and len(inner) == 1 and isinstance(only.value, dict) and not conditions:
            inner = only.value  # a group that only pushes a namespace is the group of that namespace
        if inner:
            add(body, "group", item.with_value({**conditions, **inner}))

    def _arg(self, item: Item, body: dict[str, Item]) -> None:
        name = item.entries.get("name")
        if name is None or not isinstance(name.value, str):
            self._complain(item.at, "arg: the attribute 'name' is missing")
            return
        spec: dict[str, Item] = {}
        if "default" in item.entries:
            default = item.entries["default"]
            text = str(default.value).lower() if isinstance(default.value, bool) else str(default.value)
            spec["default"], self._texts[name.value] = typed(default), default.with_value(text)
        if "description" in item.entries and item.entries["description"].value:
            spec["doc"] = item.entries["description"]
        if "choice" in item.entries:
            choices = [choice.entries["value"] for choice in items(item.entries["choice"]) if "value" in choice.entries]
            spec["choices"] = Item([typed(choice) for choice in choices], item.entries["choice"].place)
        self._args[name.value] = item.with_value(spec)

    def _include(self, item: Item, body: dict[str, Item]) -> None:
        entries: dict[str, Item] = {k: item.entries[k] for k in ("file", "if", "unless") if k in item.entries}
        args = [arg for key in ("arg", "let") for arg in items(item.entries.get(key))]
        if args:
            pairs = [pair(arg, "name", "value", self._complain, is_written=True) for arg in args]
            entries["args"] = Item({key: value for pair in pairs for key, value in pair.entries.items()}, item.place)
        add(body, "include", item.with_value(entries))

    def _timer(self, item: Item, body: dict[str, Item]) -> None:
        period = item.entries.get("period")
        if period is None:
            self._complain(item.at, "timer: the attribute 'period' is missing")
            return
        inner = self._block(children(item))
        if typed(period).value == 0:  # a step must have a delay; launch starts the actions at once
            if inner:
                add(body, "group", item.with_value({**self._conditions(item), **inner}))
            return
        step = self._add_step(body, "timer", item, {"delay": typed(period)})
        after = Item(step, item.place, item.place)
        if set(inner) - {"nodes", "steps"}:
            add(body, "group", item.with_value({"after": after, **inner}))
            return
        for section in ("nodes", "steps"):
            for name, entry in inner.get(section, Item({}, item.place)).entries.items():
                put(body, section, name, entry.with_value({"after": after, **entry.entries}))

    def _each_if(self, group: Item) -> list[Item]:
        """Return the actions of a group, each with the group's condition."""
        found = []
        for action in children(group):
            for name, inner in action.entries.items() if self._conditions(group) else ():
                if isinstance(inner.value, list):  # a group
                    inner = inner.with_value({"children": inner})
                inner = inner.without("if", "unless").with_value({**inner.entries, **conditions(group, inner)})
                action = action.with_value({name: inner})
            found.append(action)
        return found

    def _conditions(self, item: Item) -> dict[str, Item]:
        return {key: item.entries[key] for key in CONDITIONS if key in item.entries}

    def _node(self, item: Item, body: dict[str, Item]) -> None:
        package, name = item.entries.get("pkg"), item.entries.get("exec")
        is_file = package is None and name is not None and "/" in str(name.value)
        if name is None or not isinstance(name.value, str) or not (is_file or _text(package)):
            if not item.entries.keys() & FORMER.keys():  # else the former name is reported
                self._complain(item.at, "node: the attributes 'pkg' and 'exec' are needed")
            return
        found = executables.find(_text(package), name.value, self._root) if package is not None else None
        own = item.entries.get("name")
        entries: dict[str, Item] = {}
        if "namespace" in item.entries:
            entries["namespace"] = item.entries["namespace"]
        if "remap" in item.entries:
            pairs = [pair(remap, "from", "to", self._complain) for remap in items(item.entries["remap"])]
            rules = {key: value for pair in pairs for key, value in pair.entries.items()}
            entries["remap"] = Item(rules, item.entries["remap"].place, item.entries["remap"].key)
        params(item, entries, self._complain, self._note)
        if found is None:
            entries = {**self._program(item, package, name), **entries}
        else:
            ros_arguments(item, entries, self._note)
            entries = {"class": Item(found.class_path, name.place, item.at), **entries}
        if found is None or not found.is_always_active:
            entries |= self._lifecycle(item)
        if "process" in item.entries:  # of a component
            entries["process"] = item.entries["process"]
        if "launch-prefix" in item.entries:
            entries["prefix"] = item.entries["launch-prefix"]
        entries |= self._common(item)
        usual = executables.as_name(name.value) if found is None else found.node_name
        key = own.value if own is not None and isinstance(own.value, str) else usual
        self._add_node(body, key, item.with_value(entries).with_key(own.place if own is not None else item.key))

    def _lifecycle(self, item: Item) -> dict[str, Item]:
        if has_value(item, "autostart", "true", "1"):
            return {"lifecycle": item.entries["autostart"].with_value("active")}
        return {"lifecycle": item.entries["brought_to"]} if "brought_to" in item.entries else {}

    def _program(self, item: Item, package: Item | None, name: Item) -> dict[str, Item]:
        """Return the entries of a node that is a program: of the workspace, of ROS, or a file."""
        entries = {"exec": name}
        if package is not None:
            entries = {"pkg": package, "exec": name}
            own = find_workspace(self._root).packages.get(_text(package)) or bundled().packages.get(_text(package))
            if own is None or own.known_as(str(name.value)) is None:
                text = f"{package.value} {name.value}: no node of that name is here; ros2 runs it"
                self._note(name.place, f"{text}, which must be installed")
        words, for_ros = (words_of(item.entries.get(key)) for key in ("args", "ros_args"))
        if for_ros:
            words += ["--ros-args", *(word for word in for_ros if word != "--ros-args"), "--"]
        if words:
            place = item.entries.get("args", item.entries.get("ros_args", name)).place
            entries["args"] = Item([Item(word, place) for word in words], place, place)
        # As in launch: without a name no `__node` rule is given, and all nodes of the program keep theirs.
        if "name" not in item.entries:
            entries["keep_names"] = Item(True, name.place, name.key)
        return entries

    def _executable(self, item: Item, body: dict[str, Item]) -> None:
        command = item.entries.get("cmd")
        if command is None:
            self._complain(item.at, "executable: the attribute 'cmd' is missing")
            return
        entries = self._common(item)
        is_list = isinstance(command.value, list)
        texts = [str(part.value) for part in command.items] if is_list else [str(command.value)]
        # So that the command is recognized as a step, and runs without a ROS 2.
        texts = [text.replace("$(find-exec ros2)", "ros2") for text in texts]
        try:
            words = texts if is_list else split(texts[0])
        except ValueError as error:
            self._complain(command.place, f"cmd: {error}")
            return
        needs_shell = has_value(item, "shell", "true", "1")
        # launch fails only when it starts the command, which a condition may prevent.
        may_not_run = "if" in item.entries or "unless" in item.entries
        if is_list and not (needs_shell or may_not_run) and (fault := one_word_fault(texts)):
            self._complain(command.place, fault)
            return
        line = " ".join(texts)
        if needs_shell and plain_words(line)[:1] == ["ros2"]:
            words, needs_shell = plain_words(line), False
        step = step_of(words, command, self._complain)
        if step is not None:
            self._add_step(body, words[2], item, {**step, "timeout": Item(PATIENCE, command.place)})
            return
        if needs_shell:
            words = ["sh", "-c", line]
        words = _prefixed(item.entries.get("launch-prefix"), words)
        if "cwd" in item.entries:
            words = ["env", "-C", str(item.entries["cwd"].value), *words]
        if words[:1] == ["ros2"]:  # graphflow has ros2's commands, and need not find it on the PATH
            words[0] = "graphflow"
        entries = {"command": Item([Item(word, command.place) for word in words], command.place, item.at), **entries}
        own = item.entries.get("name")
        base = executables.as_name(words[0].removeprefix("$(find-exec ").rstrip(")"))
        key = f"{base}_{self._next(base)}"
        if own is not None:  # a label, which several processes may share
            count = self._next(f"label {own.value}")
            key = str(own.value) if count == 1 else f"{own.value}_{count}"
        self._add_node(body, key, item.with_value(entries))

    def _common(self, item: Item) -> dict[str, Item]:
        """Return the entries that nodes and programs share: conditions, environment, restarts and order."""
        entries = self._conditions(item)
        get = item.entries.get
        if "env" in item.entries:
            pairs = [pair(variable, "name", "value", self._complain) for variable in items(item.entries["env"])]
            entries["env"] = Item({k: v for pair in pairs for k, v in pair.entries.items()}, item.entries["env"].place)
        respawn = get("respawn")
        retries = get("respawn_max_retries")
        never = retries is not None and typed(retries).value == 0
        if respawn is not None and has_value(item, "respawn", "true", "1") and not never:
            settings = {"policy": Item("always", respawn.place)}
            for key, ours in (("respawn_delay", "delay"), ("respawn_max_retries", "max_restarts")):
                value = get(key)
                # To launch, 0 or less is no delay, and a negative number of retries is no limit.
                if value is not None and _is_positive(value):
                    settings[ours] = typed(value)
            entries["restart"] = Item(settings, respawn.place, respawn.key)
        if "on_exit" in item.entries:
            entries["on_exit"] = item.entries["on_exit"]
        before = get("after_number")
        predecessor = None if before is None else self._numbered.get(_scalar(before))
        if before is not None and predecessor is not None:
            name, is_step = predecessor
            needs = {name: Item("done", before.place) if is_step else item.entries["after_what"]}
            entries["after"] = Item(needs, before.place, before.place)
        elif before is not None:
            self._note(before.place, "its predecessor is not among the nodes and programs before it")
        if "number" in item.entries:
            entries["number"] = item.entries["number"]
        return entries

    def _add_node(self, body: dict[str, Item], key: str, item: Item) -> None:
        number, item = item.entries.get("number"), item.without(*RECORDED)
        if number is not None:
            self._numbered[_scalar(number)] = (key, False)
        put(body, "nodes", key, item)

    def _add_step(self, body: dict[str, Item], word: str, item: Item, step: dict[str, Item]) -> str:
        """Add a step named by a word and a number; returns its name."""
        name, common = f"{word}_{self._next(word)}{self._of}", self._common(item)
        if "number" in item.entries:
            self._numbered[_scalar(item.entries["number"])] = (name, True)
        before: dict[str, Item] = {key: common[key] for key in ("if", "unless", "after") if key in common}
        put(body, "steps", name, item.with_value({**step, **before}))
        return name

    def _next(self, word: str) -> int:
        self._count[word] = self._count.get(word, 0) + 1
        return self._count[word]


def _sets_anything(group: Item) -> bool:
    return any(SAME.get(key, key) in _SCOPING for child in children(group) for key in child.entries)


def _text(item: Item | None) -> str:
    """Return the text of an attribute; empty if it is missing or no text."""
    return item.value if item is not None and isinstance(item.value, str) else ""


def _is_positive(item: Item) -> bool:
    """Return whether a number is positive; the value of a substitution, known only later, counts as such."""
    number = typed(item).value
    return not isinstance(number, (int, float)) or number > 0


def _scalar(item: Item) -> Scalar:
    return None if isinstance(item.value, (dict, list)) else item.value


def _prefixed(prefix: Item | None, words: list[str]) -> list[str]:
    """Return a command line behind its prefix."""
    if prefix is not None and "$(" in str(prefix.value):  # it may become several words, or none
        return ["sh", "-c", f"exec {prefix.value} {shlex.join(words)}"]
    return [*words_of(prefix), *words]
