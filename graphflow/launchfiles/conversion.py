"""ROS's launch files as graph files: the YAML dialect, and what `xml_source` makes of XML, in our own words.

    launch:                                              nodes:
    - arg: {name: rate, default: "2.0"}                    /lab/talker:
    - group:                                                 class: nodes.talker:Talker
      - push_ros_namespace: {namespace: lab}       ->        params: {rate: $(var rate)}
      - node: {pkg: demo_nodes_py, exec: talker,         (and args: {rate: {default: 2.0}})
               param: [{name: rate, value: $(var rate)}]}

What sets something for all actions after it (a namespace, a parameter, a remap, a variable) becomes a group around
them. Every value keeps its place. What has no words here is a problem, with its line.

Source: launch and launch_ros, the parsers of their frontends; the design articles on launch XML and YAML.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from graphflow.errors import Place
from graphflow.launchfiles.attributes import children, items, says, shape_fault, split
from graphflow.launchfiles.attributes import words as words_of
from graphflow.launchfiles.commands import Complain, one_word_fault, plain_words, step_of, typed
from graphflow.launchfiles.components import KNOWN, components
from graphflow.launchfiles.settings import as_text, conditional, conditions, pair, params, ros_words, setting
from graphflow.markup import ros1_words
from graphflow.markup.tree import Item, located
from graphflow.names import did_you_mean
from graphflow.workspace import executables
from graphflow.workspace.packages import bundled, find_workspace

FROM_LAUNCH = "from a launch file"
"""The key that a launch file of ROS's has once it is a graph file; what ROS lets pass is no mistake in one."""

_ANY = {"if", "unless"}
_IGNORED = {"output", "emulate_tty", "sigterm_timeout", "sigkill_timeout", "exec_name", "log_cmd"}
"""Attributes without an effect here: output is always logged, and stopping is always the same."""
_RECORDED = {"number", "after_number", "after_what", "brought_to"}
"""Attributes that `recorded` adds: which action it is, after which it comes, the state that it is brought to."""
_RUN = {
    *_RECORDED,
    "launch-prefix",
    "name",
    "env",
    "respawn",
    "respawn_delay",
    "respawn_max_retries",
    "on_exit",
    *_ANY,
    *_IGNORED,
}
_KNOWN: dict[str, set[str]] = {
    "arg": {"name", "default", "description", "choice", *_ANY},
    "let": {"name", "value", *_ANY},
    "set_env": {"name", "value", *_ANY},
    "append_env": {"name", "value", "prepend", "separator", *_ANY},
    "group": {"children", "scoped", "forwarding", "keep", *_ANY, *_RECORDED},
    "include": {"file", "arg", "let", *_ANY, *_RECORDED},
    "node": {"pkg", "exec", "namespace", "args", "ros_args", "remap", "param", "autostart", *_RUN},
    **KNOWN,
    "executable": {"cmd", "cwd", "shell", *_RUN},
    "push_ros_namespace": {"namespace", *_ANY},
    "set_parameter": {"name", "value", "type", *_ANY},
    "set_remap": {"from", "to", *_ANY},
    "set_use_sim_time": {"value", *_ANY},
    "timer": {"period", "children", *_ANY, *_RECORDED},
    "log": {"message", "level", *_ANY, *_RECORDED},
    "shutdown": {"reason", *_ANY, *_RECORDED},
}
"""Actions that have words here, and their attributes."""
KNOWN_ACTIONS = frozenset(_KNOWN)
_SAME = {"ros_timer": "timer", "push-ros-namespace": "push_ros_namespace", "lifecycle_node": "node"}
_ELSEWHERE = {
    "unset_env": "write env: in a group or at a node",
    "reset_env": "write env: in a group or at a node",
    "set_parameters_from_file": "write param: [{from: FILE}] at the nodes",
    "set_ros_log_dir": "set the environment variable ROS_LOG_DIR",
}
_FORMER = {"type": "exec", "package": "pkg", "executable": "exec", "ns": "namespace"}
"""Attributes as launch files in Python, and some of ROS 1, have them."""
PATIENCE = 60.0
"""Seconds that a command of ROS's may take, which would wait for ever for a server."""
_SCOPING = ("push_ros_namespace", "set_parameter", "set_remap", "set_env", "append_env", "set_use_sim_time", "let")


def is_launch_file(top: Item) -> bool:
    """Whether what was read is of ROS's dialect."""
    return "launch" in top.entries and isinstance(top.entries["launch"].value, list)


def ignore(place: Place, text: str) -> None:
    """Nobody wants to know."""


def recorded(actions: list[dict[str, Any]], file: str) -> Item:
    """A launch file in Python as an item: what `supervisor.launch_recorder` has written down of it."""

    def action(said: dict[str, Any]) -> Item:
        [(name, attributes)] = said.items()
        place = Place(file, attributes.pop("line"), 1)
        children = attributes.pop("children", None)
        item = located(attributes, place)
        if children is not None:
            item.value["children"] = Item([action(child) for child in children], place)
        return Item({name: item._replace(key=place)}, place)

    top = Place(file, 1, 1)
    return Item({"launch": Item([action(said) for said in actions], top)}, top)


def native(
    top: Item,
    root: Path,
    complain: Complain,
    note: Complain = ignore,
    number: int = 1,
    leave_out: Complain = ignore,
) -> Item:
    """A launch file as a graph file.

    Args:
        top: The file: a list of actions under `launch`.
        root: The project's folder.
        complain: Called with what has no words here.
        note: Called with what has, but which the reader should know of.
        number: Which file of the graph it is.
        leave_out: Called with components that nobody here has.
    """
    return _Translation(root, complain, note, number, leave_out).file(top)


class _Translation:
    def __init__(self, root: Path, complain: Complain, note: Complain, number: int, leave_out: Complain) -> None:
        self._root, self._complain, self._note, self._leave_out = root, complain, note, leave_out
        self._of = f"_of_{number}" if number > 1 else ""
        self._args: dict[str, Item] = {}
        self._texts: dict[str, Item] = {}  # their defaults as they are written
        self._count: dict[str, int] = {}
        self._numbered: dict[int, tuple[str, bool]] = {}
        """The names of actions that others come after, and whether they are steps."""

    def file(self, top: Item) -> Item:
        body = self._block(top.entries["launch"].value)
        args = {"args": Item(self._args, top.place)} if self._args else {}
        return top._replace(value={FROM_LAUNCH: Item(self._texts, top.place), **args, **body})

    # lists of actions

    def _block(self, actions: list[Item]) -> dict[str, Item]:
        """What actions do one after another, as the body of a file or group."""
        body: dict[str, Item] = {}
        for i, action in enumerate(actions):
            if not isinstance(action.value, dict) or len(action.value) != 1:
                text = "expected an action, for example node: {pkg: turtlesim, exec: turtlesim_node}"
                self._complain(action.place, f"{text}, got {action.plain()!r}")
                continue
            [(written, item)] = action.entries.items()
            name = _SAME.get(written, written)
            item = item._replace(key=item.key or action.place)
            if name == "group" and isinstance(item.value, list):
                item = item._replace(value={"children": item})
            if not self._is_known(name, item):
                continue
            after = actions[i + 1 :]
            if name in _SCOPING:
                _add(body, "group", self._around(name, item, after))
                break
            sets = any(_SAME.get(key, key) in _SCOPING for child in children(item) for key in child.entries)
            if name == "group" and sets and says(item, "scoped", "false", "0"):  # it holds for what comes after, too
                for key, more in self._block([*self._each_if(item), *after]).items():
                    _extend(body, key, more)
                break
            self._act(name, item, body)
        return body

    def _is_known(self, name: str, item: Item) -> bool:
        if name not in _KNOWN:
            if former := ros1_words.action(name):
                self._complain(item.at, f"<{name}> {former}")
                return False
            hint = _ELSEWHERE.get(name)
            near = f": {hint}" if hint else did_you_mean(name, _KNOWN)
            self._complain(item.at, f"the action {name!r} has no words in a graph file{near}")
            return False
        if not isinstance(item.value, dict):
            self._complain(item.place, f"{name}: expected a mapping of its attributes, got {item.plain()!r}")
            return False
        for key, value in item.entries.items():
            if key not in _KNOWN[name]:
                ours, known = _FORMER.get(key, ""), sorted(_KNOWN[name] - _IGNORED - _RECORDED - {"children"})
                former = ros1_words.attribute(name, key, value.value) or (
                    f"it is called {ours!r} here" if ours in known else ""
                )
                hint = f"; {former}" if former else did_you_mean(key, known) or f"; there is {', '.join(known)}"
                self._complain(value.at, f"{name}: unknown attribute {key!r}{hint}")
            elif (fault := shape_fault(key, value)) is not None:
                self._complain(value.place, f"{name}: {fault}")
        return True

    def _around(self, name: str, item: Item, after: list[Item]) -> Item:
        """A group around the actions that come after one which sets something for them."""
        if self._conditions(item) and name not in ("let", "push_ros_namespace"):
            self._complain(item.at, f"{name}: a condition here has no words in a graph file; put it on a group")
        nothing = Item("", item.place)
        if name == "let":
            variable = item.entries.get("name", nothing)
            value = conditional(item, item.entries.get("value", nothing), f"$(var {variable.value} '')")
            loop = {"var": variable, "in": Item([as_text(value)], item.place), **self._block(after)}
            return item._replace(value={"for": Item(loop, item.place)})
        key, value = setting(name, item, self._complain)
        rest = self._block(after)
        inner = rest.get("group")
        only = inner is not None and len(rest) == 1 and isinstance(inner.value, dict) and key not in inner.value
        body = inner.value if inner is not None and only else rest
        return item._replace(value={key: value, **body})

    # actions

    def _act(self, name: str, item: Item, body: dict[str, Item]) -> None:
        if name == "arg":
            self._arg(item)
        elif name == "node":
            self._node(item, body)
        elif name in KNOWN:
            for component in components(item, self._root, self._complain, self._leave_out):
                self._node(component, body)
        elif name == "executable":
            self._executable(item, body)
        elif name == "log":
            message = item.entries.get("message", Item("", item.place))
            if message.value:
                self._add_step(body, "log", item, {"log": message})
        elif name == "shutdown":
            reason = item.entries.get("reason", Item("a launch file asks for it", item.place))
            self._add_step(body, "shutdown", item, {"shutdown": reason})
        elif name == "include":
            _add(body, "include", self._include(item))
        elif name == "group":
            inner = self._block(children(item))
            conditions = self._conditions(item)
            only = inner.get("group")
            if only is not None and len(inner) == 1 and isinstance(only.value, dict) and not conditions:
                inner = only.value  # a group that only has a namespace pushed is that group
            if inner:
                _add(body, "group", item._replace(value={**conditions, **inner}))
        elif name == "timer":
            self._timer(item, body)

    def _arg(self, item: Item) -> None:
        name = item.entries.get("name")
        if name is None or not isinstance(name.value, str):
            self._complain(item.at, "arg: the attribute 'name' is missing")
            return
        spec: dict[str, Item] = {}
        if "default" in item.entries:
            default = item.entries["default"]
            text = str(default.value).lower() if isinstance(default.value, bool) else str(default.value)
            spec["default"], self._texts[name.value] = typed(default), default._replace(value=text)
        if "description" in item.entries and item.entries["description"].value:
            spec["doc"] = item.entries["description"]
        if "choice" in item.entries:
            choices = [choice.entries["value"] for choice in items(item.entries["choice"]) if "value" in choice.entries]
            spec["choices"] = Item([typed(choice) for choice in choices], item.entries["choice"].place)
        self._args[name.value] = item._replace(value=spec)

    def _include(self, item: Item) -> Item:
        entries: dict[str, Item] = {k: item.entries[k] for k in ("file", "if", "unless") if k in item.entries}
        args = [arg for key in ("arg", "let") for arg in items(item.entries.get(key))]
        if args:
            pairs = [pair(arg, "name", "value", self._complain, is_written=True) for arg in args]
            entries["args"] = Item({key: value for pair in pairs for key, value in pair.entries.items()}, item.place)
        return item._replace(value=entries)

    def _timer(self, item: Item, body: dict[str, Item]) -> None:
        period = item.entries.get("period")
        if period is None:
            self._complain(item.at, "timer: the attribute 'period' is missing")
            return
        inner = self._block(children(item))
        if typed(period).value == 0:
            if inner:
                _add(body, "group", item._replace(value={**self._conditions(item), **inner}))
            return
        step = self._add_step(body, "timer", item, {"delay": typed(period)})
        after = Item(step, item.place, item.place)
        if set(inner) - {"nodes", "steps"}:
            _add(body, "group", item._replace(value={"after": after, **inner}))
            return
        for section in ("nodes", "steps"):
            for name, entry in inner.get(section, Item({}, item.place)).entries.items():
                _put(body, section, name, entry._replace(value={"after": after, **entry.entries}))

    def _each_if(self, group: Item) -> list[Item]:
        """The actions in a group, each with the group's condition."""
        made = []
        for action in children(group):
            for name, inner in action.entries.items() if self._conditions(group) else ():
                if isinstance(inner.value, list):  # a group
                    inner = inner._replace(value={"children": inner})
                inner = inner.without("if", "unless")._replace(value={**inner.entries, **conditions(group, inner)})
                action = action._replace(value={name: inner})
            made.append(action)
        return made

    def _conditions(self, item: Item) -> dict[str, Item]:
        return {key: item.entries[key] for key in _ANY if key in item.entries}

    def _node(self, item: Item, body: dict[str, Item]) -> None:
        package, name = item.entries.get("pkg"), item.entries.get("exec")
        is_file = package is None and name is not None and "/" in str(name.value)
        if name is None or not isinstance(name.value, str) or not (is_file or _is_text(package)):
            if not item.entries.keys() & _FORMER.keys():  # else that is told
                self._complain(item.at, "node: the attributes 'pkg' and 'exec' are needed")
            return
        found = executables.find(package.value, name.value, self._root) if package is not None else None
        own = item.entries.get("name")
        entries: dict[str, Item] = {}
        if "namespace" in item.entries:
            entries["namespace"] = item.entries["namespace"]
        if "remap" in item.entries:
            pairs = [pair(remap, "from", "to", self._complain) for remap in items(item.entries["remap"])]
            rules = {key: value for pair in pairs for key, value in pair.entries.items()}
            entries["remap"] = Item(rules, item.entries["remap"].place, item.entries["remap"].key)
        params(item, entries, self._complain)
        if found is None:
            entries = {**self._program(item, package, name), **entries}
        else:
            ros_words(item, entries, self._note)
            entries = {"class": Item(found.class_path, name.place, item.at), **entries}
        if "brought_to" in item.entries:
            entries["lifecycle"] = item.entries["brought_to"]
        if says(item, "autostart", "true", "1"):
            entries["lifecycle"] = item.entries["autostart"]._replace(value="active")
        if "process" in item.entries:  # of a component
            entries["process"] = item.entries["process"]
        if "launch-prefix" in item.entries:
            entries["prefix"] = item.entries["launch-prefix"]
        entries |= self._common(item)
        usual = executables.as_name(name.value) if found is None else found.node_name
        key = own.value if own is not None and isinstance(own.value, str) else usual
        self._add_node(body, key, item._replace(value=entries, key=own.place if own is not None else item.key))

    def _program(self, item: Item, package: Item | None, name: Item) -> dict[str, Item]:
        """A program of the workspace, one that only ROS has, or a file."""
        entries = {"exec": name}
        if package is not None:
            entries = {"pkg": package, "exec": name}
            own = find_workspace(self._root).packages.get(package.value) or bundled().packages.get(package.value)
            if own is None or own.known_as(name.value) is None:
                text = f"{package.value} {name.value}: no node of that name is here; ros2 runs it"
                self._note(name.place, f"{text}, which must be installed")
        words, for_ros = (words_of(item.entries.get(key)) for key in ("args", "ros_args"))
        if for_ros:
            words += ["--ros-args", *(word for word in for_ros if word != "--ros-args"), "--"]
        if words:
            place = item.entries.get("args", item.entries.get("ros_args", name)).place
            entries["args"] = Item([Item(word, place) for word in words], place, place)
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
        texts = [str(part.value) for part in command.value] if is_list else [str(command.value)]
        texts = [text.replace("$(find-exec ros2)", "ros2") for text in texts]
        try:
            words = texts if is_list else split(texts[0])
        except ValueError as error:
            self._complain(command.place, f"cmd: {error}")
            return
        is_shells = says(item, "shell", "true", "1")
        may_not_run = "if" in item.entries or "unless" in item.entries
        if is_list and not (is_shells or may_not_run) and (fault := one_word_fault(texts)):
            self._complain(command.place, fault)
            return
        line = " ".join(texts)
        if is_shells and plain_words(line)[:1] == ["ros2"]:
            words, is_shells = plain_words(line), False
        step = step_of(words, command, self._complain)
        if step is not None:
            self._add_step(body, words[2], item, {**step, "timeout": Item(PATIENCE, command.place)})
            return
        if is_shells:
            words = ["sh", "-c", line]
        words = [*words_of(item.entries.get("launch-prefix")), *words]
        if "cwd" in item.entries:
            words = ["env", "-C", str(item.entries["cwd"].value), *words]
        if words[:1] == ["ros2"]:
            words[0] = "graphflow"
        entries = {"command": Item([Item(word, command.place) for word in words], command.place, item.at), **entries}
        own = item.entries.get("name")
        base = executables.as_name(words[0].removeprefix("$(find-exec ").rstrip(")"))
        key = f"{base}_{self._next(base)}"
        if own is not None:  # a label, which several may have
            count = self._next(f"label {own.value}")
            key = str(own.value) if count == 1 else f"{own.value}_{count}"
        self._add_node(body, key, item._replace(value=entries))

    def _common(self, item: Item) -> dict[str, Item]:
        """What nodes and programs share."""
        entries = self._conditions(item)
        get = item.entries.get
        if "env" in item.entries:
            pairs = [pair(variable, "name", "value", self._complain) for variable in items(item.entries["env"])]
            entries["env"] = Item({k: v for pair in pairs for k, v in pair.entries.items()}, item.entries["env"].place)
        respawn = get("respawn")
        if respawn is not None and says(item, "respawn", "true", "1"):
            settings = {"policy": Item("always", respawn.place)}
            for key, ours in (("respawn_delay", "delay"), ("respawn_max_retries", "max_restarts")):
                value = get(key)
                if value is not None and not str(value.value).startswith(("-", "0")):
                    settings[ours] = typed(value)
            entries["restart"] = Item(settings, respawn.place, respawn.key)
        if "on_exit" in item.entries:
            entries["on_exit"] = item.entries["on_exit"]
        before = get("after_number")
        if before is not None and before.value in self._numbered:
            name, is_step = self._numbered[before.value]
            needs = {name: Item("done", before.place) if is_step else item.entries["after_what"]}
            entries["after"] = Item(needs, before.place, before.place)
        elif before is not None:
            self._note(before.place, "what it is to come after is not among the nodes and programs before it")
        if "number" in item.entries:
            entries["number"] = item.entries["number"]
        return entries

    def _add_node(self, body: dict[str, Item], key: str, item: Item) -> None:
        number, item = item.entries.get("number"), item.without(*_RECORDED)
        if number is not None:
            self._numbered[number.value] = (key, False)
        _put(body, "nodes", key, item)

    def _add_step(self, body: dict[str, Item], word: str, item: Item, step: dict[str, Item]) -> str:
        """Add a step that is called by a word and a number; returns its name."""
        name, common = f"{word}_{self._next(word)}{self._of}", self._common(item)
        if "number" in item.entries:
            self._numbered[item.entries["number"].value] = (name, True)
        before = {key: common[key] for key in ("if", "unless", "after") if key in common}
        _put(body, "steps", name, item._replace(value={**step, **before}))
        return name

    def _next(self, word: str) -> int:
        self._count[word] = self._count.get(word, 0) + 1
        return self._count[word]


def _is_text(item: Item | None) -> bool:
    return item is not None and isinstance(item.value, str)


def _extend(body: dict[str, Item], key: str, more: Item) -> None:
    """Add what another body has under a key."""
    if key in ("nodes", "steps"):
        for name, entry in more.entries.items():
            _put(body, key, name, entry)
    else:
        for block in more.value if isinstance(more.value, list) else [more]:
            _add(body, key, block)


def _put(body: dict[str, Item], section: str, key: str, item: Item) -> None:
    """Add an entry to a section of a body; one whose key is there already in a group of its own."""
    old = body.get(section, Item({}, item.place, item.at))
    if key in old.value:  # whether it is there twice is reported when all names are whole
        _add(body, "group", Item({section: Item({key: item}, item.place)}, item.place))
    else:
        body[section] = old._replace(value={**old.value, key: item})


def _add(body: dict[str, Item], key: str, item: Item) -> None:
    """Add a block of a kind of which there may be several."""
    old = body.get(key)
    if old is None:
        body[key] = item
    elif isinstance(old.value, list):
        body[key] = old._replace(value=[*old.value, item])
    else:
        body[key] = Item([old, item], old.place, old.key)
