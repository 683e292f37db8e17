"""Details of the selected node as tabs: log, parameters, topics, groups and crash; and the logs of all nodes."""

from __future__ import annotations

from textual.widget import Widget

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.registry import view_class
from graphflow.tui.view import View

ALL = "all"
"""The tab with the logs of all nodes."""
TABS = {ALL: "all", "log": "log", "params": "params", "topics": "topics", "groups": "groups", "crash": "history"}
"""The views of a node, and the labels of their tabs."""
SETTLED_AFTER = 0.15
"""Seconds for which the cursor rests on a node before it is shown, so that passing over nodes costs nothing."""


class Detail(View):
    """One view of the selected node, with tabs for the others."""

    NAME = "detail"
    DOC = "the chosen node: log, params, topics, groups, history; all logs"
    EVERY = 0.1
    ACTIONS = (
        Action("tab:1", "next tab", keys=("right_square_bracket",), label="[ ] tabs", hint=True),
        Action("tab:-1", "previous tab", keys=("left_square_bracket",)),
    )
    can_focus = True

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._inner: View | None = None
        self._wanted, self._since = "", 0.0

    @property
    def _tab(self) -> str:
        tab = str(self.options.get("tab", ALL))
        return tab if tab in TABS else ALL

    @property
    def active(self) -> View:
        return self if self._inner is None else self._inner

    @property
    def title(self) -> str:
        tabs = " ".join(f"[{word}]" if tab == self._tab else word for tab, word in TABS.items())
        whole = f"{self.about}  {tabs}".lstrip()
        if len(whole) < self.size.width:
            return whole
        return f"{self.about}  [{TABS[self._tab]}] {[*TABS].index(self._tab) + 1} of {len(TABS)}".lstrip()

    @property
    def note(self) -> str:
        return "" if self._inner is None else self._inner.note

    @property
    def focus_target(self) -> Widget:
        return self if self._inner is None else self._inner.focus_target

    def chosen(self) -> dict[str, str]:
        return {"node": self.about} if self.about else {}

    def shows(self, content: Content) -> bool:
        """Open the tab for the requested content; return whether there is one."""
        if content.view not in TABS or not content.about or content.about != self.hub.selected:
            return False
        self.options["tab"] = content.view
        self._replace(content)
        return True

    def look(self, now: float) -> None:
        selected = self.hub.selected
        if selected != self._wanted:
            self._wanted, self._since = selected, now
        if self._inner is None or (selected != self.about and now - self._since >= SETTLED_AFTER):
            self._show_tab()
        if self._inner is not None and self._inner.is_mounted and now - self._inner.looked >= self._inner.EVERY:
            self._inner.looked = now
            self._inner.look(now)

    def _show_tab(self) -> None:
        """Show the tab's view of the selected node."""
        self.about = self.hub.selected
        if self._tab == ALL:
            if self._inner is None or self._inner.about or self._inner.NAME != "log":
                self._replace(Content("log"))
        elif self.about:
            self._replace(Content(self._tab, self.about))

    def _replace(self, content: Content) -> None:
        """Replace the view, or show another node in it."""
        had_focus = self.has_focus or (self._inner is not None and self._inner.has_focus_within)
        if self._inner is not None:
            self._inner.remove()
        self.about = self._wanted = self.hub.selected
        self._inner = view_class(content.view)(self.hub, content)
        self.mount(self._inner)
        if had_focus:
            self.call_after_refresh(self.focus_inside)

    def do_tab(self, step: str) -> None:
        """Go to the next tab, or the previous one."""
        tabs = list(TABS)
        self.options["tab"] = tabs[(tabs.index(self._tab) + int(step)) % len(tabs)]
        self._show_tab()
        if self._tab != ALL and not self.about:
            self.say("choose a node in the list of nodes first")

    def interrupt(self) -> bool:
        return self._inner is not None and self._inner.interrupt()

    def restyle(self) -> None:
        if self._inner is not None:
            self._inner.restyle()

    @property
    def content(self) -> Content:
        return Content(self.NAME, "", {"tab": self._tab})


VIEW = Detail
