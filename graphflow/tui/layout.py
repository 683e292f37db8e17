"""The windows of a console, and their form as plain data: saved with a run, and written to graph files."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

from graphflow.tui.panes import MAX_PANES, MAX_WINDOWS, Axis, Content, Pane, Split, Window


class Layout:
    """The windows of a console by number, one of them current."""

    def __init__(self) -> None:
        self.windows: dict[int, Window] = {}
        self.current = 0
        self.last = 0
        self._numbers = itertools.count(1)

    @property
    def window(self) -> Window:
        return self.windows[self.current]

    def make_pane(self, content: Content, share: float = 1.0) -> Pane:
        """Make a pane with an unused number."""
        return Pane(next(self._numbers), content, share)

    def open(self, name: str, root: Pane | Split, layout: str = "") -> int:
        """Add a window under the lowest free number; return the number."""
        number = next(n for n in itertools.count() if n not in self.windows)
        self.windows[number] = window = Window(name or next(_panes(root)).content.view, root)
        self.windows = dict(sorted(self.windows.items()))
        if layout:
            window.arrange(layout)
        return number

    def select(self, number: int) -> bool:
        """Make a window current; return whether it exists."""
        if number in self.windows and number != self.current:
            self.last, self.current = self.current, number
        return number in self.windows

    def step(self, by: int) -> None:
        """Go to the next window, or the previous one."""
        numbers = list(self.windows)
        self.select(numbers[(numbers.index(self.current) + by) % len(numbers)])

    def close(self, number: int) -> bool:
        """Close a window; return False if it is the last."""
        if len(self.windows) == 1:
            return False
        numbers = list(self.windows)
        if self.current == number:
            at = numbers.index(number)
            back = self.last if self.last in self.windows and self.last != number else numbers[at - 1 if at else 1]
            self.current = back
        del self.windows[number]
        if self.last not in self.windows:
            self.last = self.current
        return True

    def holder(self, pane: int) -> tuple[int, Window] | None:
        """Return the window that contains a pane."""
        return next(((n, w) for n, w in self.windows.items() if pane in w.numbers), None)

    # as data

    def to_json(self) -> dict[str, object]:
        """Return the windows as plain data, to be saved with the run."""
        return {
            "current": self.current,
            "windows": [
                {
                    "number": number,
                    "name": window.name,
                    "layout": window.layout,
                    "focused": window.numbers.index(window.focused),
                    "zoomed": window.zoomed,
                    "root": _to_json(window.root),
                }
                for number, window in self.windows.items()
            ],
        }

    @classmethod
    def from_json(cls, data: Any) -> Layout:
        """Read the result of `to_json`, or of `console_section`.

        Raises:
            ValueError: The data is neither.
        """
        layout = cls()
        try:
            windows = list(data["windows"])[:MAX_WINDOWS]
            for window in windows:
                number = layout.open(str(window.get("name") or "")[:40], layout.read_tree(window["root"]))
                opened = layout.windows[number]
                if window.get("layout"):
                    _keep_or_arrange(opened, str(window["layout"]), is_saved="focused" in window)
                numbers = opened.numbers
                opened.focused = numbers[int(window.get("focused", 0)) % len(numbers)]
                opened.last_focused = opened.focused
                opened.zoomed = bool(window.get("zoomed"))
            current = int(data.get("current", 0))
        except (KeyError, TypeError, AttributeError, RecursionError) as error:
            raise ValueError(f"not a layout: {error!r}") from None
        if not layout.windows:
            raise ValueError("not a layout: no window")
        layout.current = current if current in layout.windows else next(iter(layout.windows))
        layout.last = layout.current
        return layout

    def read_tree(self, data: Mapping[str, Any]) -> Pane | Split:
        """Read the tree of a window as `to_json` wrote it, with new pane numbers."""
        share = float(data.get("size") or 0.0)
        if "split" in data:
            of: list[Pane | Split] = [self.read_tree(inner) for inner in list(data["of"])[:MAX_PANES]]
            sized = [n.share for n in of if n.share > 0]
            rest = max(100.0 - sum(sized), 10.0) if sized else 100.0
            unsized = [n for n in of if n.share <= 0]
            for node in unsized:
                node.share = rest / len(unsized)
            if len(of) == 1:
                of[0].share = share
                return of[0]
            axis: Axis = "rows" if data["split"] == "rows" else "columns"
            return Split(axis, of, share)
        content = Content(str(data["view"]), str(data.get("about") or ""), dict(data.get("options") or {}))
        return self.make_pane(content, share)


def _keep_or_arrange(window: Window, layout: str, *, is_saved: bool) -> None:
    """Restore a window: a saved one keeps its sizes and its layout's name; one from a graph file is arranged."""
    if is_saved:
        window.layout = layout
    else:
        window.arrange(layout)


def _panes(node: Pane | Split) -> Iterator[Pane]:
    if isinstance(node, Pane):
        yield node
    else:
        for inner in node.of:
            yield from _panes(inner)


def _to_json(node: Pane | Split) -> dict[str, object]:
    if isinstance(node, Pane):
        content = node.content
        return {"view": content.view, "about": content.about, "options": content.options, "size": node.share}
    return {"split": node.axis, "of": [_to_json(n) for n in node.of], "size": node.share}


def to_section(layout: Layout) -> dict[str, object]:
    """Convert the windows to the `console:` section of a graph file, with sizes as shares of 100."""
    return {"windows": [{"name": w.name, "panes": _section(w.root, None)} for w in layout.windows.values()]}


def _section(node: Pane | Split, size: int | None) -> object:
    if isinstance(node, Pane):
        content = node.content
        options = dict(content.options)
        if not content.about and not options and size is None:
            return content.view
        return {content.view: content.about or None, **options, **({} if size is None else {"size": size})}
    total = sum(n.share for n in node.of) or 1.0
    even = len({round(n.share / total, 2) for n in node.of}) == 1
    of = [_section(n, None if even else max(1, round(100 * n.share / total))) for n in node.of]
    return {node.axis: of, **({} if size is None else {"size": size})}
