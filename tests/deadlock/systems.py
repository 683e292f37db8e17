"""Systems of nodes with groups, services, actions and call trees, as data, and a generator of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

from hypothesis import strategies as st


@dataclass(frozen=True, slots=True)
class Nap:
    """Wait for time to pass."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Fail:
    """Raise an error after a while."""

    after: float = 0.0


@dataclass(frozen=True, slots=True)
class Ask:
    """Call a service or send a goal; `steps` is what the handler does for it."""

    server: int
    steps: Steps = ()
    how: Literal["result", "block", "feedback"] = "result"
    """How the end of a goal is waited for; a block that is left cancels it."""
    timeout: float | None = None
    is_tolerant: bool = True
    """Go on when it fails."""


@dataclass(frozen=True, slots=True)
class Both:
    """Wait for all of them."""

    of: tuple[Work, ...]
    how: How = "gather"


@dataclass(frozen=True, slots=True)
class Either:
    """Wait for the first of them, and cancel the others."""

    of: tuple[Work, ...]


@dataclass(frozen=True, slots=True)
class Meet:
    """Wait for the end of a task of one's own node."""

    starter: int


How = Literal["gather", "group", "wait", "gather errors"]
"""The latter two wait for those who are left when one has failed."""
Work = Nap | Fail | Ask | Both | Either | Meet


@dataclass(frozen=True, slots=True)
class Step:
    """What a handler waits for at one time."""

    work: Work
    is_released: bool = False
    """Without its slot, which it takes again afterwards."""
    limit: float | None = None
    """It gives up after so many seconds, and goes on."""


Steps = tuple[Step, ...]


class Place(NamedTuple):
    """Where a handler is: a node, and one of the system's groups or none."""

    node: int
    group: int | None


@dataclass(frozen=True, slots=True)
class Server:
    """A service, or an action by its policy."""

    place: Place
    kind: Literal["service", "queue", "parallel"]

    @property
    def is_action(self) -> bool:
        return self.kind != "service"


@dataclass(frozen=True, slots=True)
class Starter:
    """Begins a call tree, once or twice."""

    place: Place
    kind: Literal["timer", "subscription", "task"]
    after: float
    times: int
    steps: Steps


@dataclass(frozen=True, slots=True)
class System:
    """Nodes before their start."""

    processes: tuple[int, ...]
    """By node."""
    groups: tuple[tuple[int, int], ...]
    """Node and limit of each."""
    replies: tuple[int | None, ...]
    """By node: the group in which answers to its calls are delivered, as in ROS 2."""
    servers: tuple[Server, ...]
    starters: tuple[Starter, ...]
    delay: float = 0.0
    """Seconds that something takes on the network, at most."""
    have_handlers: bool = True
    """Whether every node has a handler besides."""


def slots(place: Place, own: str, kind: str) -> list[str]:
    """The slots that a run of a handler takes: of its group, and the one for which it queues behind itself."""
    group = [] if place.group is None or kind == "task" else [f"group{place.group}"]
    is_alone = kind == "queue" or (place.group is None and kind not in ("parallel", "task"))
    return [*group, own] if is_alone else group


def asks_of(steps: Steps) -> Iterator[Ask]:
    """The requests that a handler makes itself."""
    todo: list[Work] = [step.work for step in steps]
    while todo:
        work = todo.pop()
        todo += work.of if isinstance(work, (Both, Either)) else ()
        if isinstance(work, Ask):
            yield work


def trees_of(system: System) -> Iterator[tuple[int, Ask]]:
    """Every request of a system, and the node that makes it."""
    todo = [(starter.place.node, ask) for starter in system.starters for ask in asks_of(starter.steps)]
    while todo:
        node, ask = todo.pop()
        yield node, ask
        todo += [(system.servers[ask.server].place.node, inner) for inner in asks_of(ask.steps)]


SECONDS = st.sampled_from([0.05, 0.1, 0.2, 0.3, 0.7])
LONGER = st.sampled_from([0.05, 0.1, 0.2, 0.3, 0.7, 3.0])
ALONE = st.sampled_from([*["ask"] * 6, "both", "either", "either", "nap", "meet"])
TOGETHER = st.sampled_from([*["ask"] * 5, "nap", "both", "either", "meet"])
HOWS: st.SearchStrategy[Literal["result", "block", "feedback"]] = st.sampled_from(["result", "block", "feedback"])
JOINTS: st.SearchStrategy[How] = st.sampled_from(["gather", "group", "wait", "gather errors"])
BRITTLE: st.SearchStrategy[How] = st.sampled_from(["gather", "group"])
"""Those of which a failure is noticed at once."""
KINDS: st.SearchStrategy[Literal["service", "queue", "parallel"]] = st.sampled_from(
    ["service", "service", "service", "queue", "parallel"]
)
STARTS: st.SearchStrategy[Literal["timer", "subscription", "task"]] = st.sampled_from(
    ["timer", "timer", "subscription", "subscription", "task"]
)


@st.composite
def systems(draw: st.DrawFn, *, ends: bool = False, replies: bool = True) -> System:
    """Up to 4 nodes with 4 servers and 3 starters, and up to 8 requests in all.

    Args:
        ends: Some waits are given up after a while, and some work fails.
        replies: Answers may need slots.
    """
    processes = draw(st.sampled_from([(0,), (0, 1), (0, 1), (0, 0, 1), (0, 1, 1, 0)]))
    nodes = st.integers(0, len(processes) - 1)
    limits = st.sampled_from([1, 1, 2, 2, 3])
    groups = tuple((draw(nodes), draw(limits)) for _ in range(draw(st.integers(1, 4))))
    homes = [Place(node, group) for group, (node, _) in enumerate(groups)]
    places = st.one_of(st.sampled_from(homes), st.builds(Place, nodes, st.none()))
    servers = tuple(Server(draw(places), draw(KINDS)) for _ in range(draw(st.integers(2, 4))))
    requests = 8

    def work(me: Place, depth: int, kinds: st.SearchStrategy[str], width: int) -> Work:
        nonlocal requests
        if ends and draw(st.integers(0, 9)) > (8 if width == 2 else 6):
            return Fail(draw(SECONDS))
        match draw(kinds):
            case "both" if width:
                return Both(several(me, depth, width), draw(BRITTLE if ends else JOINTS))
            case "either" if width:
                return Either(several(me, depth, width))
            case "ask" if requests:
                requests -= 1
                others = [i for i, server in enumerate(servers) if server.place != me]
                asked = draw(st.sampled_from([*range(len(servers)), *others, *others]))
                return Ask(asked, steps(servers[asked].place, depth + 1), draw(HOWS), *end())
            case "meet" if met := tasks(me, depth):
                return Meet(draw(st.sampled_from(met)))
            case _:
                return Nap(draw(SECONDS if width == 2 else LONGER))

    def end() -> tuple[float | None, bool]:
        return (draw(st.sampled_from([None, None, None, 0.6, 2.0])), draw(st.booleans())) if ends else (None, True)

    def tasks(me: Place, depth: int) -> list[int]:
        """Which may be waited for; a ring of tasks alone is none that anybody looks for."""
        now = len(starters)
        found = [i for i, (place, kind) in enumerate(begun) if kind == "task" and place.node == me.node]
        return [i for i in found if i < now] if depth == 0 and begun[now][1] == "task" else found

    def several(me: Place, depth: int, width: int) -> tuple[Work, ...]:
        return tuple(work(me, depth, TOGETHER, width - 1) for _ in range(draw(st.integers(2, 3))))

    def steps(me: Place, depth: int) -> Steps:
        if depth > 3:
            return ()
        return tuple(step(me, depth) for _ in range(draw(st.integers(0 if depth else 1, 2))))

    def step(me: Place, depth: int) -> Step:
        limit = draw(st.sampled_from([*[None] * 5, 0.5, 1.5])) if ends else None
        return Step(work(me, depth, ALONE, 2), draw(st.integers(0, 4)) > 2, limit)

    begun = [(draw(places), draw(STARTS)) for _ in range(draw(st.integers(1, 3)))]
    starters: list[Starter] = []
    for place, kind in begun:
        starters.append(Starter(place, kind, draw(SECONDS), draw(st.integers(1, 2)), steps(place, 0)))
    own: list[list[int]] = [[i for i, (node, _) in enumerate(groups) if node == n] for n in range(len(processes))]
    answers = tuple(draw(st.sampled_from([*[None] * 5, *(mine if replies else ())])) for mine in own)
    return System(processes, groups, answers, servers, tuple(starters), draw(st.sampled_from([0.0, 0.02])))
