"""Variables by which two classes exchange values."""

from __future__ import annotations

from graphflow import Node, timer
from graphflow.runtime.mistakes.source.module_variables import exchanged

latest: object = None
count = 0


class Watch(Node):
    """Sets a variable."""

    @timer(1.0)
    def look(self) -> None:
        """Set it."""
        global latest
        latest = self


class Drive(Node):
    """Reads it."""

    @timer(1.0)
    def drive(self) -> None:
        """Read it."""
        if latest is not None:
            self.log.info("go")


class Own(Node):
    """Reads what it sets, and what its own node sets."""

    @timer(1.0)
    def work(self) -> None:
        """Count."""
        global count
        count += 1
        if latest is not None:
            self.log.info("%s", Watch)


def test_a_variable_of_another_class() -> None:
    """It is told at its first use, with the class that sets it."""
    [found] = exchanged(Drive)
    assert found.setter is Watch
    place = f"{__file__}:{Drive.drive.__code__.co_firstlineno + 3}"
    assert found.text == (
        f"{place}: Watch sets latest, and runs in another process: send it on a topic, or give both nodes the same "
        "process:"
    )


def test_variables_of_its_own() -> None:
    """One that the class sets, and one of a class whose nodes it may make, are left alone."""
    assert exchanged(Watch) == exchanged(Own) == ()
