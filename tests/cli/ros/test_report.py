"""`graphflow doctor --report`."""

from __future__ import annotations

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_a_report(standing: Machine) -> None:
    """The report has ROS 2's sections; on request, only those of failed checks."""
    text = standing.look("doctor", "--report", code=1)
    for title in ("PLATFORM INFORMATION", "NETWORK CONFIGURATION", "RMW MIDDLEWARE", "TOPIC LIST", "PACKAGE VERSIONS"):
        assert f"\n   {title}\n" in text
    assert "topic            : /chatter" in text
    failed = standing.look("doctor", "-rf", code=1)
    assert [line.strip() for line in failed.splitlines() if line.startswith("   ")] == ["QOS COMPATIBILITY LIST"]
