"""The `console:` section of a graph file: the windows and panes that a console opens with.

    console:
      prefix: ctrl+a
      windows:
        - name: drive
          panes: {columns: [{rows: [nodes, {log: /turtlesim, level: warn}], size: 40}, turtle]}
        - name: why
          layout: even-vertical
          panes: [groups, {echo: /turtle1/pose}]

A pane is the name of a view, or `{view: subject}` with the view's options beside it. `rows` and `columns`
split the space among panes; `size` is a share of it, 50 being half. A plain list of panes is arranged by `layout`.

The result is plain data, in the form that a console saves with a run:
{"prefix", "theme", "windows": [{"name", "layout", "root"}]}, where a root is
{"view", "about", "options", "size"} or {"split": "rows" or "columns", "of", "size"}.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from graphflow.console.views import VIEWS, ViewForm, known_views
from graphflow.errors import Place
from graphflow.names import did_you_mean, nearest

if TYPE_CHECKING:
    from graphflow.markup import source
    from graphflow.markup.source import Source


LAYOUTS = ("even-horizontal", "even-vertical", "main-horizontal", "main-vertical", "tiled")
THEMES = ("graphflow-dark", "graphflow-light", "ansi-dark", "ansi-light")
_LEVELS = ("debug", "info", "warn", "error", "fatal")
_PREFIX = re.compile(r"ctrl\+[a-z]\Z")
_SPLITS = ("rows", "columns")

Complain = Callable[[Place, str], None]


def console_section(src: Source, complain: Complain) -> dict[str, object] | None:
    """Read the section of a file; return None if there is none.

    Args:
        complain: Called with each mistake.
    """
    data = src.data.get("console") if isinstance(src.data, dict) else None
    return None if data is None else _Section(src, complain).read(data)


class _Section:
    def __init__(self, src: Source, complain: Complain) -> None:
        self._src, self._complain = src, complain

    def read(self, data: object) -> dict[str, object]:
        at: source.Path = ("console",)
        section = self._mapping(data, at, ("prefix", "theme", "windows"), "console: {windows: [{panes: [nodes, log]}]}")
        if section is None:
            return {}
        self._choice(section, at, "theme", THEMES)
        prefix = section.get("prefix")
        if prefix is not None and not (isinstance(prefix, str) and _PREFIX.match(prefix)):
            self._complain(self._src.place((*at, "prefix")), f"prefix: expected ctrl and a letter, got {prefix!r}")
        windows = section.get("windows") or []
        if not isinstance(windows, list):
            self._complain(self._src.place((*at, "windows")), "windows: expected a list of windows")
            windows = []
        return {
            "prefix": prefix,
            "theme": section.get("theme"),
            "windows": [self._window(window, (*at, "windows", i)) for i, window in enumerate(windows)],
        }

    def _window(self, data: object, at: source.Path) -> dict[str, object]:
        window = self._mapping(data, at, ("name", "layout", "panes"), "{name: drive, panes: [nodes, log]}")
        if window is None:
            return {}
        self._choice(window, at, "layout", LAYOUTS)
        panes = window.get("panes")
        if isinstance(panes, list):
            root = self._split({"columns": panes}, (*at, "panes"), (*at, "panes"))
        elif panes is None:
            self._complain(self._src.place(at), "a window needs panes, for example panes: [nodes, log]")
            root = {}
        else:
            root = self._pane(panes, (*at, "panes"))
        return {"name": str(window.get("name") or ""), "layout": window.get("layout"), "root": root}

    def _pane(self, data: object, at: source.Path) -> dict[str, object]:
        if isinstance(data, str):
            data = {data: ""}
        if not isinstance(data, dict) or not data:
            self._complain(self._src.place(at), f"expected a view, or rows or columns of views, got {data!r}")
            return {}
        split = next((key for key in _SPLITS if key in data), None)
        if split is not None:
            return self._split(data, at, (*at, split))
        return self._view(data, at)

    def _split(self, data: dict[str, object], at: source.Path, below: source.Path) -> dict[str, object]:
        split = next(key for key in _SPLITS if key in data)
        for key in set(data) - {split, "size"}:
            self._complain(self._src.key_place((*at, key)), f"{key!r} is not allowed beside {split}; only size is")
        of = data[split]
        if not isinstance(of, list) or not of:
            self._complain(self._src.place(below), f"{split}: expected a list of views, got {of!r}")
            of = []
        panes = [self._pane(pane, (*below, i)) for i, pane in enumerate(of)]
        return {"split": split, "of": panes, "size": self._size(data, at)}

    def _view(self, data: dict[str, object], at: source.Path) -> dict[str, object]:
        known = known_views()
        view = next((key for key in data if key in known), None)
        if view is None:
            word = str(next(iter(data)))
            self._complain(self._src.place(at), f"{word!r} is not a view{did_you_mean(word, known) or _all(known)}")
            return {}
        form = VIEWS.get(view)
        about = data[view]
        about = "" if about is None else str(about)
        if form is not None:
            self._check(form, view, about, data, at)
        options = {k: v for k, v in data.items() if k not in (view, "size")}
        return {"view": view, "about": about, "options": options, "size": self._size(data, at)}

    def _check(self, form: ViewForm, view: str, about: str, data: dict[str, object], at: source.Path) -> None:
        if form.needs_it and not about:
            self._complain(self._src.place(at), f"{view} needs a {form.about}: {{{view}: ...}}")
        if about and not form.about:
            self._complain(self._src.place(at), f"{view} takes no argument; write {view} alone")
        for key in set(data) - {view, "size", *form.options}:
            text = f"{view} has no option {key!r}{did_you_mean(key, form.options) or _all(form.options)}"
            self._complain(self._src.key_place((*at, key)), text)
        if view == "log":
            self._choice(data, at, "level", _LEVELS)
            pattern = data.get("filter")
            if isinstance(pattern, str):
                self._regex(pattern, (*at, "filter"))

    def _regex(self, text: str, at: source.Path) -> None:
        try:
            re.compile(text)
        except re.error as error:
            self._complain(self._src.place(at), f"filter: not a regular expression: {error}")

    def _size(self, data: dict[str, object], at: source.Path) -> float:
        size = data.get("size", 0)
        if isinstance(size, bool) or not isinstance(size, (int, float)) or not 0 <= size <= 100:
            self._complain(self._src.place((*at, "size")), f"size: expected a share from 1 to 100, got {size!r}")
            return 0.0
        return float(size)

    def _choice(self, data: dict[str, object], at: source.Path, key: str, choices: tuple[str, ...]) -> None:
        value = data.get(key)
        if value is not None and value not in choices:
            near = nearest(str(value), choices)
            guess = f"; did you mean {near!r}?" if near else ""
            text = f"{key}: expected one of {', '.join(choices)}, got {value!r}{guess}"
            self._complain(self._src.place((*at, key)), text)

    def _mapping(self, data: object, at: source.Path, keys: tuple[str, ...], example: str) -> dict[str, object] | None:
        if not isinstance(data, dict):
            where = str(at[-1]) if isinstance(at[-1], str) else "a window"
            self._complain(self._src.place(at), f"{where}: expected a mapping, for example {example}")
            return None
        for key in data:
            if key not in keys:
                self._complain(self._src.key_place((*at, key)), f"unknown key {key!r}{did_you_mean(str(key), keys)}")
        return data


def _all(names: Collection[str]) -> str:
    return f"; there are {', '.join(names)}" if names else "; it has none"
