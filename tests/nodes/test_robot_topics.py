"""Rates by simulated time; the topics themselves are tested with the simulator."""

from nodes.robot_topics import Due


def test_rates() -> None:
    """A message is due once a period; a jump in time makes up for nothing."""
    due = Due(5.0)
    assert [time for time in range(0, 100, 5) if due.is_now(time / 100)] == [0, 20, 40, 60, 80]
    assert due.is_now(50.0)
    assert not due.is_now(50.1)
    due.restart()
    assert due.is_now(0.0)
