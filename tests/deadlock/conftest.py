"""What tests of readers of source share."""

from __future__ import annotations

from tests.written import written

__all__ = ["written"]
