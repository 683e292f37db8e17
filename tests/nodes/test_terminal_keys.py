"""Keys as they are pressed."""

import asyncio
import itertools
import os
import termios
from collections.abc import Iterator

import pytest

from nodes.terminal_keys import HANGUP, decode_keys, keyboard


@pytest.fixture
def terminal() -> Iterator[tuple[int, int]]:
    """A terminal: where its keys are pressed, and where they are read."""
    pressing, reading = os.openpty()
    yield pressing, reading
    for end in (pressing, reading):
        try:
            os.close(end)
        except OSError:
            pass


@pytest.mark.parametrize(
    ("pressed", "keys"),
    [
        (b"\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        (b"\x1bOA\x1bOD", ["up", "left"]),
        (b"\x1b[1;5A", ["up"]),
        (b"qQ 1\n", ["q", "Q", " ", "1", "\n"]),
        (b"\x1b[3~x\x1bOPy\x1b[24;2~", ["x", "y"]),
        ("ä".encode(), []),
        (b"\x1bq", ["escape", "q"]),
        (b"\x1b\x1b[A", ["escape", "up"]),
        (b"\x1b[\x03q", ["escape", "[", "\x03", "q"]),
        (b"", []),
    ],
)
def test_keys_have_names(pressed: bytes, keys: list[str]) -> None:
    """Arrows as all terminals send them; unnamed keys are skipped."""
    assert decode_keys(pressed) == (keys, b"")


def test_keys_may_come_in_pieces() -> None:
    """However the bytes are cut in three, the keys are the same."""
    pressed = b"a\x1b[A\x1bOB\x1b[1;2Cq"
    for i, j in itertools.combinations_with_replacement(range(len(pressed) + 1), 2):
        keys: list[str] = []
        begun = b""
        for piece in (pressed[:i], pressed[i:j], pressed[j:]):
            more, begun = decode_keys(begun + piece)
            keys += more
        assert (keys, begun) == (["a", "up", "down", "right", "q"], b"")


@pytest.mark.parametrize("begun", [b"\x1b", b"\x1b[", b"\x1b[1;", b"\x1bO"])
def test_a_key_that_has_begun_is_kept(begun: bytes) -> None:
    """The following bytes decide."""
    assert decode_keys(b"q" + begun) == (["q"], begun)


async def test_keys_arrive_without_return_and_unseen(
    terminal: tuple[int, int], graphflow_runner: asyncio.Runner
) -> None:
    """Each when it is pressed; the terminal does not echo them."""
    pressing, reading = terminal
    with keyboard(reading) as keys:
        os.write(pressing, b"\x1b")
        os.write(pressing, b"[A")
        assert await keys.get() == "up"
        os.write(pressing, b"q")
        assert await keys.get() == "q"
        os.set_blocking(pressing, False)
        with pytest.raises(BlockingIOError):
            os.read(pressing, 1)


async def test_the_terminal_is_given_back_however_it_ends(
    terminal: tuple[int, int], graphflow_runner: asyncio.Runner
) -> None:
    """After an error or a cancellation, its settings are restored and it is no longer read."""
    _, reading = terminal
    before = termios.tcgetattr(reading)

    with pytest.raises(ZeroDivisionError), keyboard(reading):
        assert termios.tcgetattr(reading) != before
        raise ZeroDivisionError
    assert termios.tcgetattr(reading) == before

    async def wait() -> None:
        with keyboard(reading) as keys:
            await keys.get()

    waiting = asyncio.create_task(wait())
    await asyncio.sleep(0)
    assert termios.tcgetattr(reading) != before
    waiting.cancel()
    with pytest.raises(asyncio.CancelledError):
        await waiting
    assert termios.tcgetattr(reading) == before
    assert not asyncio.get_running_loop().remove_reader(reading)


async def test_a_terminal_that_goes_away_is_the_last_key(
    terminal: tuple[int, int], graphflow_runner: asyncio.Runner
) -> None:
    """It is reported once, the loop does not spin, and there is nothing to restore."""
    pressing, reading = terminal
    with keyboard(reading) as keys:
        os.close(pressing)
        assert await keys.get() == HANGUP
        assert not asyncio.get_running_loop().remove_reader(reading)
