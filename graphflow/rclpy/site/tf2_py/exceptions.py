"""Why a transform cannot be had."""

from __future__ import annotations


class TransformException(Exception):
    """There is no such transform; the others say why."""


class ConnectivityException(TransformException):
    """The two frames are in trees of their own."""


class LookupException(TransformException):
    """Nobody has said anything about the frame."""


class ExtrapolationException(TransformException):
    """What is known begins after the time that was asked for, or ends before it."""


class InvalidArgumentException(TransformException):
    """The name of a frame is wrong."""


class TimeoutException(TransformException):
    """It has taken too long."""
