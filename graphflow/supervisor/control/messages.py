"""Messages of the control socket, from a supervisor to its clients: one JSON object a line, tagged by `event`.

The types describe what `json` reads and writes; nothing is converted at run time. Import them for type checking only.
"""

from __future__ import annotations

from typing import Literal, TypeAlias, TypedDict

Layout: TypeAlias = dict[str, object]
"""The windows and panes of a console, as `tui.layout` reads them."""

NodeRow = TypedDict(
    "NodeRow",
    {
        "node": str,
        "is_named": bool,
        "state": str,
        "lifecycle": str,
        "pid": int | None,
        "since": float,
        "process": str | None,
        "number": int,
        "class": str,
        "log": str,
        "restarts": int,
        "detail": str,
        "last_end": str,
    },
)
"""A node as `ps` shows it. `since` is in seconds since 1970, `number` identifies the node in its process."""


class Console(TypedDict):
    """An attached console."""

    name: str
    since: float
    """Seconds since 1970."""


# Events: sent to all clients that follow the graph.


class Hello(TypedDict):
    """The first event of a client that follows the graph."""

    event: Literal["hello"]
    version: str
    graph: str
    file: str
    console: Layout | None
    """The layout of the graph file."""
    layout: Layout | None
    """The layout that the last console has left."""


class Note(TypedDict):
    """A remark about the graph's environment."""

    event: Literal["note"]
    text: str


class Trouble(TypedDict):
    """An error of the graph; as a reply, the reason why a request was refused."""

    event: Literal["error"]
    message: str


class Starting(TypedDict):
    event: Literal["starting"]
    process: str
    again: bool


class NodeReady(TypedDict):
    event: Literal["ready"]
    node: str
    pid: int | None


class NodeLeft(TypedDict):
    """A node was unloaded from its process."""

    event: Literal["left"]
    node: str
    process: str


class ProcessExited(TypedDict):
    event: Literal["exited"]
    process: str
    nodes: list[str]
    pid: int | None
    how: str
    unexpected: bool
    error: str
    log: str
    again: float | None
    """Seconds until the process is started again; None if it is not."""
    given_up: str
    """Why it is not started again, though its policy is to."""


class StepEnded(TypedDict):
    event: Literal["step"]
    step: str
    ok: bool
    text: str


class StepText(TypedDict):
    """The text of a `log` step."""

    event: Literal["said"]
    text: str


class Up(TypedDict):
    """All that the graph needs at first is ready."""

    event: Literal["up"]
    seconds: float
    pending: dict[str, str]
    """Needs by node, for nodes that wait for the end of another process."""


class Checked(TypedDict):
    """The examination of the graph's files is over."""

    event: Literal["checked"]


class Stopping(TypedDict):
    event: Literal["stopping"]
    reason: str


class End(TypedDict):
    """The last event."""

    event: Literal["end"]
    exit_code: int


class Consoles(TypedDict):
    """The consoles that are attached now."""

    event: Literal["consoles"]
    consoles: list[Console]


class Announced(TypedDict):
    """A client has changed something."""

    event: Literal["announced"]
    text: str
    by: str


GraphEvent: TypeAlias = (
    Hello
    | Note
    | Trouble
    | Starting
    | NodeReady
    | NodeLeft
    | ProcessExited
    | StepEnded
    | StepText
    | Up
    | Checked
    | Stopping
    | End
    | Consoles
    | Announced
)

# Replies to a request.


class NodeList(TypedDict):
    event: Literal["ps"]
    nodes: list[NodeRow]
    consoles: list[Console]


class PlanReply(TypedDict):
    event: Literal["plan"]
    plan: dict[str, object]
    """As `Plan.to_json` writes it."""
    folder: str
    """The supervisor's working directory."""


class Loaded(TypedDict):
    """A node was loaded or unloaded."""

    event: Literal["loaded"]
    number: int
    node: str


class Done(TypedDict):
    event: Literal["done"]
    do: str


Reply: TypeAlias = Hello | NodeList | PlanReply | Loaded | Done | Trouble
