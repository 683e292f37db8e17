"""A subscription's record of a publisher."""

from __future__ import annotations

from graphflow.executor.clock import WallClock
from graphflow.qos import INFINITE_NS
from graphflow.runtime.endpoints.events import SilenceTimer
from graphflow.runtime.endpoints.sources import Source


def test_the_time_of_messages_matters_where_they_expire_or_are_signs_of_life() -> None:
    """Only then is the time read; a lease that was set stays."""
    source = Source(INFINITE_NS)
    assert not source.needs_care
    source.expects(10)
    assert source.needs_care
    lease = SilenceTimer(WallClock(), 10, lambda: None)
    source.expects(INFINITE_NS, lease)
    source.expects(INFINITE_NS)
    assert (source.lease, source.needs_care) == (lease, True)
