"""The table of views."""

from __future__ import annotations

from graphflow.console.views import VIEWS, known_views


def test_a_view_that_must_be_told_something_says_what() -> None:
    """The error for a view without its subject names the kind of subject."""
    assert all(form.about for form in VIEWS.values() if form.needs_it)


def test_the_known_views_begin_with_those_of_graphflow() -> None:
    """Views of other packages follow in order."""
    known = known_views()
    assert known[: len(VIEWS)] == list(VIEWS)
    assert known[len(VIEWS) :] == sorted(known[len(VIEWS) :])
