"""The console's own actions: one method `do_<name>` for each row of `actions.CONSOLE`."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from graphflow.console.section import LAYOUTS
from graphflow.console.views import VIEWS, known_views
from graphflow.tui.commands.actions import carry_out, console_actions, keys_of, shown
from graphflow.tui.commands.history import without_program
from graphflow.tui.commands.pane_commands import PaneCommands
from graphflow.tui.panes import Content
from graphflow.tui.widgets.colours import DARK, LIGHT
from graphflow.tui.widgets.dialogs import Ask, AskToStop, Choice, Item, Note, Pick
from graphflow.tui.widgets.line_view import LineView
from graphflow.workspace import project

_ALSO_VERBS = ("groups",)
"""Views that share their name with a verb: followed by more words, the name is the verb."""


class ConsoleCommands(PaneCommands):
    """Carries out the console's actions."""

    def do(self, name: str) -> None:
        """Carry out an action."""
        carry_out(self, name)

    def look(self, now: float) -> None:
        """Report new deadlocks, whichever views are open."""
        app, live = self._app, self._app.hub.live
        if live is None:
            return
        live.want("concurrency")
        if live.concurrency is not None:
            found = len(live.deadlocks)
            seen = any(frame.view.NAME in ("groups", "tour") for frame in app.workspace.visible_frames)
            if found > app.deadlocks and not seen:
                app.say(f"DEADLOCK found; {shown(app.prefix)} g shows it and how to end it", bad=True)
            app.deadlocks = found

    # leaving

    def do_detach(self) -> None:
        self._app.run_worker(self._app.leave("detach"))

    def do_pause_in_shell(self) -> None:
        if self._app.job_control.has_shell:
            self._app.job_control.pause()
        else:
            self._app.say("this console was not started from a shell")

    def do_interrupt(self) -> None:
        """Handle Ctrl-C, which never stops the graph without a question, however often it is pressed."""
        app, view = self._app, self._app.focused_view
        if isinstance(app.screen, AskToStop):
            return
        if len(app.screen_stack) > 1:
            app.pop_screen()
        elif view is None or not view.interrupt():
            self.do_ask_to_stop()

    def do_ask_to_stop(self) -> None:
        app = self._app
        supervision = app.hub.supervision
        if supervision is None:
            self._ask("No supervisor here: these nodes were started elsewhere.", [Choice("d", "leave")], self._leave)
            return
        nodes = len(supervision.nodes)
        question = f"Leave or stop {app.hub.graph}, {nodes} node{'s' if nodes != 1 else ''}?"
        others = [console["name"] for console in supervision.consoles if console["name"] != supervision.name]
        also = f"Stopping ends it for the other console{'s' if len(others) > 1 else ''}, too: {', '.join(others)}"
        choices = [Choice("d", "detach: the nodes run on"), Choice("s", "stop the graph")]
        app.push_screen(AskToStop(question, choices, also if others else ""), self._leave)

    def _ask(
        self, question: str, choices: list[Choice], on_answer: Callable[[str | None], None], detail: str = ""
    ) -> None:
        self._app.push_screen(Ask(question, choices, detail), on_answer)

    def _leave(self, answer: str | None) -> None:
        if answer == "d":
            self.do_detach()
        elif answer == "s":
            self.stop_now()

    def stop_now(self) -> None:
        """Stop the graph, and leave once it has ended."""
        self._app.run_worker(self._app.leave("stop"))

    def do_dismiss_welcome(self) -> None:
        """Hide the line for newcomers."""
        if self._app.welcome.display:
            self._app.welcome.put_away()
            self._app.say(f"the line for newcomers is hidden; {shown(self._app.prefix)} ? has all keys")

    def do_sessions(self) -> None:
        from graphflow.supervisor.rundir import running

        runs = running()
        here = self._app.hub.supervision
        items = [
            Item(r.graph, f"domain {r.domain}  {r.file}", None if here and r.run_id == here.run.run_id else r.socket)
            for r in runs
        ]

        def picked(socket: str | None) -> None:
            if socket:
                self._app.run_worker(self._app.leave(f"switch {socket}"))

        self._app.push_screen(Pick("Running graphs", items, "no other graph is running"), picked)

    # the graph

    def do_find(self) -> None:
        from graphflow.tui.widgets.pickable import parameters, things

        def picked(content: Content | None) -> None:
            if content is not None:
                self.open_beside(content)

        pick: Pick = Pick("Find in the graph", things(self._app.hub), "not connected yet")
        self._app.push_screen(pick, picked)

        async def add_parameters() -> None:
            pick.add(await parameters(self._app.hub))

        self._app.spawn(add_parameters)

    def do_groups(self) -> None:
        self._app.did("graphflow waits")
        self.open_window(Content("groups"))

    def do_newest_error(self) -> None:
        self.show_newest_error("")

    def show_newest_error(self, node: str) -> None:
        """Show the newest error in the log of its node.

        Args:
            node: Restrict the search to this node; empty for all.
        """
        errors = self._app.hub.logs.last_error
        error = errors.get(node) if node else next(iter(reversed(errors.values())), None)
        if error is None:
            self._app.say(f"no error in the log{f' of {node}' if node else 's'} so far")
            return
        self._app.did(f"graphflow logs {error.node} --level error")
        self.open_beside(Content("log", error.node, {"at": f"{error.file}:{error.offset}"}))

    def do_restart_node(self) -> None:
        view = self._app.focused_view
        node = view.chosen().get("node", "") if view is not None else ""
        if node:
            self.restart(node)
        else:
            self._app.say("choose a node first, in the list of nodes")

    def restart(self, node: str) -> None:
        """Confirm, then restart a node."""
        supervision = self._app.hub.supervision
        if self._has_no_supervisor():
            return
        if supervision is None or node not in supervision.nodes:
            self._app.say(
                f"{node} was not started by this graph's supervisor, so it cannot be restarted here", bad=True
            )
            return
        process = supervision.nodes[node]["process"]
        companions = [n for n, row in supervision.nodes.items() if process and row["process"] == process and n != node]
        detail = f"It shares a process with {', '.join(companions)}, which restart too." if companions else ""

        def on_answer(key: str | None) -> None:
            if key == "r":
                supervision.send(do="restart", node=node)
                self._app.did(f"graphflow restart {node}")

        if supervision.nodes[node]["state"] in ("ended", "failed", "given_up"):
            on_answer("r")
        else:
            self._ask(f"Restart {node}?", [Choice("r", "restart")], on_answer, detail)

    def _has_no_supervisor(self) -> bool:
        """Return whether no supervisor could start or stop a node; if so, say how to start the graph again."""
        supervision = self._app.hub.supervision
        if supervision is None or not (supervision.is_lost or supervision.exit_code is not None):
            return False
        again = f"graphflow up {project.shown(Path(supervision.run.file))}"
        what = "the supervisor has gone" if supervision.exit_code is None else "the graph has ended"
        self._app.say(f"{what}; q leaves, and to start the graph again: {again}", bad=True)
        return True

    def stop_node(self, node: str) -> None:
        """Confirm, then stop a node."""
        supervision = self._app.hub.supervision
        if self._has_no_supervisor():
            return
        if supervision is None or node not in supervision.nodes:
            self._app.say(f"{node} was not started by this graph's supervisor, so it cannot be stopped here", bad=True)
            return

        def on_answer(key: str | None) -> None:
            if key == "s":
                supervision.send(do="stop", node=node)
                self._app.did(f"graphflow stop {node}")

        self._ask(f"Stop {node}? The others run on.", [Choice("s", "stop it")], on_answer)

    def do_search_logs(self) -> None:
        self.open_window(Content("log"), "logs")
        self._app.call_after_refresh(self._search_here)

    def _search_here(self) -> None:
        from graphflow.tui.views.log import Log

        view = self._app.focused_view
        if isinstance(view, Log):
            view.do_filter()

    def do_mute_node(self) -> None:
        view = self._app.focused_view
        node = view.chosen().get("node", "") if view is not None else ""
        if not node:
            self._app.say("choose a node, or a line of its log, first")
            return
        muted = self._app.hub.muted
        muted.symmetric_difference_update({node})
        self._app.say(f"{node} is {'muted' if node in muted else 'no longer muted'} in merged logs")

    def do_palette(self) -> None:
        from graphflow.tui.widgets.pickable import contents

        app, view = self._app, self._app.focused_view
        actions = view.ACTIONS if view is not None else ()
        items = [Item(a.title, ", ".join(map(shown, a.keys)), (view, a.name)) for a in actions]
        items += [Item(a.title, keys_of(a, app.prefix), (self, a.name)) for a in console_actions()]
        items += [Item(item.text, f"show: {item.detail}", item.value) for item in contents(app.hub)]

        def picked(chosen: tuple[object, str] | Content | None) -> None:
            if isinstance(chosen, Content):
                self.open_beside(chosen)
            elif chosen is not None:
                carry_out(*chosen)

        app.push_screen(Pick("All commands", items), picked)

    def do_command(self) -> None:
        from graphflow.tui.commands.command_line import CommandLine

        self._app.push_screen(CommandLine(self._app.hub), self._typed)

    def _typed(self, text: str | None) -> None:
        if not text or not text.strip():
            return
        text = without_program(text)
        word, _, rest = text.partition(" ")
        if (
            word in known_views()
            and not (word in _ALSO_VERBS and rest)
            and (rest or word not in VIEWS or not VIEWS[word].needs_it)
        ):
            self.open_beside(Content(word, rest))
        elif word == "layout" and rest in LAYOUTS:
            self.do_arrange(rest)
        elif word == "save-layout":
            self.do_save_layout()
        elif word in ("detach", "quit", "q"):
            self.do_detach()
        else:
            self.open_beside(Content("prompt", text, {"run": True}))

    # the console

    def do_help(self) -> None:
        from graphflow.tui.views.help import VIEW as HELP

        view = self._app.focused_view
        first = {"first": view.NAME} if view is not None else {}
        self._app.push_screen(Note("Keys", lambda: HELP(self._app.hub, Content("help", options=first))))

    def do_clients(self) -> None:
        supervision = self._app.hub.supervision
        consoles = supervision.consoles if supervision is not None else []
        items = [
            Item(
                c["name"],
                f"since {time.strftime('%H:%M:%S', time.localtime(c['since']))}"
                f"{'  (this one)' if supervision and c['name'] == supervision.name else ''}",
                None,
            )
            for c in consoles
        ]
        self._app.push_screen(Pick("Attached consoles", items, "only this one"))

    def do_clock(self) -> None:
        self._app.say(time.strftime("%A %d %B %Y, %H:%M:%S"))

    def do_theme(self) -> None:
        self._app.theme = LIGHT.name if self._app.current_theme.dark else DARK.name
        self._app.say(f"theme {self._app.theme}")

    def do_messages(self) -> None:
        def body() -> LineView[str]:
            lines = LineView[str]()
            lines.call_after_refresh(lines.replace, list(self._app.messages))
            return lines

        self._app.push_screen(Note("Messages", body))

    def do_copy_command(self) -> None:
        if not self._app.last_shell:
            self._app.say("no command has been shown yet")
            return
        self._app.copy(self._app.last_shell)
