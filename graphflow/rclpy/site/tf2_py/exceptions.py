"""Reasons for which a transform is unavailable."""

from __future__ import annotations


class TransformException(Exception):
    """A transform is unavailable; the subclasses give the reason."""


class ConnectivityException(TransformException):
    """The two frames are in separate trees."""


class LookupException(TransformException):
    """A frame is unknown."""


class ExtrapolationException(TransformException):
    """The requested time is before or after the known transforms."""


class InvalidArgumentException(TransformException):
    """A frame's name is illegal."""


class TimeoutException(TransformException):
    """The wait took too long."""
