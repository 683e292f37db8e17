"""The life of a supervised process, and the order of starting and stopping."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow.machines.process import ALARMS, START_LIMIT, STOP_LIMIT, Do, Event, Exit, Need, Order, State, step
from tests.cases import slow

P, S, R, T, E = State.PENDING, State.STARTING, State.READY, State.STOPPING, State.ENDED
A, B, W = State.RESTARTING, State.RESETTING, State.WAITING

# Written by hand, every state and every event; what is not said here changes nothing.
EFFECTS = {
    (P, Event.GO): (S, (Do.SPAWN,)),
    (P, Event.STOP): (E, ()),
    (P, Event.KILL): (E, ()),
    (S, Event.READY): (R, ()),
    (S, Event.STOP): (T, (Do.TERMINATE,)),
    (S, Event.KILL): (T, (Do.KILL,)),
    (S, Event.RESTART): (A, (Do.TERMINATE,)),
    (S, Event.RESET): (B, (Do.TERMINATE,)),
    (S, Event.LATE): (T, (Do.GIVE_UP, Do.TERMINATE)),
    (S, Event.EXIT): (E, ()),
    (R, Event.STOP): (T, (Do.TERMINATE,)),
    (R, Event.KILL): (T, (Do.KILL,)),
    (R, Event.RESTART): (A, (Do.TERMINATE,)),
    (R, Event.RESET): (B, (Do.TERMINATE,)),
    (R, Event.EXIT): (E, ()),
    (A, Event.STOP): (T, ()),
    (A, Event.KILL): (T, (Do.KILL,)),
    (A, Event.LATE): (A, (Do.KILL,)),
    (A, Event.EXIT): (S, (Do.SPAWN,)),
    (B, Event.STOP): (T, ()),
    (B, Event.KILL): (T, (Do.KILL,)),
    (B, Event.RESTART): (A, ()),
    (B, Event.LATE): (B, (Do.KILL,)),
    (B, Event.EXIT): (P, ()),
    (W, Event.STOP): (E, ()),
    (W, Event.KILL): (E, ()),
    (W, Event.RESTART): (S, (Do.SPAWN,)),
    (W, Event.RESET): (P, ()),
    (W, Event.LATE): (S, (Do.SPAWN,)),
    (E, Event.RESTART): (S, (Do.SPAWN,)),
    (E, Event.AGAIN): (W, ()),
    (T, Event.RESTART): (A, ()),
    (T, Event.KILL): (T, (Do.KILL,)),
    (T, Event.LATE): (T, (Do.KILL,)),
    (T, Event.EXIT): (E, ()),
}


@pytest.mark.parametrize("event", Event)
@pytest.mark.parametrize("state", State)
def test_every_event_in_every_state(state: State, event: Event) -> None:
    """An event does what the table says, and nothing where the table says nothing."""
    assert step(state, event) == EFFECTS.get((state, event), (state, ()))


def test_the_stop_ladder() -> None:
    """Stopping asks, waits, kills, and is over only when the process has gone."""
    state, actions = step(State.READY, Event.STOP)
    assert (state, actions) == (State.STOPPING, (Do.TERMINATE,))
    assert ALARMS[state] == STOP_LIMIT

    state, actions = step(state, Event.STOP)  # asking again does not signal again
    assert (state, actions) == (State.STOPPING, ())

    state, actions = step(state, Event.LATE)
    assert (state, actions) == (State.STOPPING, (Do.KILL,))

    assert step(state, Event.EXIT) == (State.ENDED, ())


def test_only_starting_and_stopping_have_a_time_limit() -> None:
    """A process may wait and work for as long as it likes."""
    assert ALARMS == {S: START_LIMIT, T: STOP_LIMIT, A: STOP_LIMIT, B: STOP_LIMIT}
    assert START_LIMIT > STOP_LIMIT > 0


@given(st.lists(st.sampled_from(Event)))
def test_a_spawned_process_ends_by_its_exit_alone(events: list[Event]) -> None:
    """Whatever happens, nothing is called ended that may still run, and nothing is spawned twice."""
    state, alive = State.PENDING, False
    for event in events:
        before = state
        state, actions = step(state, event)
        if event is Event.EXIT:
            alive = False
        assert not (alive and Do.SPAWN in actions)
        alive = alive or Do.SPAWN in actions
        if state is State.ENDED and before is not State.ENDED:
            assert not alive
        assert Do.SPAWN not in actions or state is State.STARTING


@pytest.mark.parametrize(
    ("status", "exit_", "failed", "text"),
    [
        (0, Exit(code=0), False, "exit code 0"),
        (1, Exit(code=1), True, "exit code 1"),
        (64, Exit(code=64), True, "exit code 64 (wrong usage)"),
        (70, Exit(code=70), True, "exit code 70 (an error in the node)"),
        (78, Exit(code=78), True, "exit code 78 (wrong configuration)"),
        (-2, Exit(signal=2), True, "signal SIGINT"),
        (-9, Exit(signal=9), True, "signal SIGKILL (killed, perhaps for lack of memory)"),
        (-11, Exit(signal=11), True, "signal SIGSEGV"),
        (-15, Exit(signal=15), True, "signal SIGTERM"),
        (-35, Exit(signal=35), True, "signal 35"),
    ],
)
def test_how_a_process_ended(status: int, exit_: Exit, failed: bool, text: str) -> None:
    """A return code as `subprocess` gives it tells code from signal, and reads as a sentence."""
    assert Exit.of_status(status) == exit_
    assert exit_.failed is failed
    assert str(exit_) == text


def order(**after: str) -> Order:
    return Order({name: frozenset(map(Need, needs.split())) for name, needs in after.items()})


DIAMOND = order(base="", left="base", right="base", top="left right")


def test_what_may_start() -> None:
    """A name may start when all it comes after is done, in the order of the file."""
    assert DIAMOND.startable([]) == ["base"]
    assert DIAMOND.startable(map(Need, ["base"])) == ["base", "left", "right"]
    assert DIAMOND.startable(map(Need, ["base", "left"])) == ["base", "left", "right"]
    assert DIAMOND.startable(map(Need, ["base", "left", "right"])) == ["base", "left", "right", "top"]


def test_names_in_no_order_start_at_once() -> None:
    """Without `after` everything may start together."""
    assert order(b="", a="").startable(()) == ["b", "a"]


def test_what_may_never_begin() -> None:
    """Names that need the end of a process, directly or through others; a step's end is sure to come."""
    needs = {
        "once": [],
        "step s": [Need("once")],
        "after": [Need("once", "done")],
        "far": [Need("after")],
        "plain": [Need("once"), Need("step s", "done")],
    }
    made = Order({name: frozenset(found) for name, found in needs.items()})
    assert made.later({"once", "after", "far", "plain"}) == {"after", "far"}
    assert made.startable([Need("once", "exited")]) == ["once"]
    assert "after" in made.startable([Need("once", "exited"), Need("once", "done")])


def test_a_diamond_stops_from_its_top() -> None:
    """What started last stops first; those of one layer stop together, in the order given."""
    assert DIAMOND.stop_layers(["base", "left", "right", "top"]) == [["top"], ["left", "right"], ["base"]]


def test_the_order_holds_across_what_is_gone() -> None:
    """Order is transitive: the middle having ended, the top still stops before the base."""
    assert DIAMOND.stop_layers(["base", "top"]) == [["top"], ["base"]]


def test_a_lopsided_diamond() -> None:
    """A name waits with its stop for everything above it, however long the other branch is."""
    tall = order(a="", b="a", c="b", d="a", e="c d")

    assert tall.stop_layers("abcde") == [["e"], ["c", "d"], ["b"], ["a"]]


def test_unordered_names_stop_together() -> None:
    """Names without order, also those the order does not know, make one layer."""
    assert order(a="", b="").stop_layers(["a", "b", "stranger"]) == [["a", "b", "stranger"]]
    assert order().stop_layers([]) == []


def test_a_circle_stops_all_the_same() -> None:
    """A circle, which checks refuse earlier, does not keep the graph from stopping."""
    assert order(a="b", b="a").stop_layers(["a", "b"]) == [["a", "b"]]


@slow
@given(st.data())
def test_stopping_reverses_any_order(data: st.DataObject) -> None:
    """In every order without circles each name stops after all that came after it, and each stops once."""
    names = [f"n{i}" for i in range(data.draw(st.integers(1, 7)))]
    after = {
        name: frozenset(data.draw(st.sets(st.sampled_from(names[:i])))) if i else frozenset[str]()
        for i, name in enumerate(names)
    }
    order = Order({name: frozenset(map(Need, needs)) for name, needs in after.items()})
    layers = order.stop_layers(data.draw(st.permutations(names)))

    place = {name: i for i, layer in enumerate(layers) for name in layer}
    assert sorted(name for layer in layers for name in layer) == sorted(names)
    assert all(place[name] < place[needed] for name in names for needed in after[name])


def test_what_is_lacking() -> None:
    """Is told in words: an end as one, and nothing that is met."""
    order = Order({"c": frozenset({Need("a"), Need("b", "done"), Need("step s", "done")})})
    assert order.lacking("c", set()) == "a, the end of b, the end of step s"
    assert order.lacking("c", {Need("a"), Need("b", "done")}) == "the end of step s"
