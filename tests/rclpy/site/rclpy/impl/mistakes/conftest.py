"""Fixtures of tests that read source."""

from __future__ import annotations

from tests.written import written

__all__ = ["written"]
