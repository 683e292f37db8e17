"""Reasons for which a transform is unavailable."""

from __future__ import annotations

from graphflow.errors import ExtrapolationError, FrameLoop, TransformError, UnknownFrame


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


def in_words_of_tf2(error: TransformError) -> TransformException:
    """Convert an error of a lookup to tf2's, whose texts programs and their users know."""
    match error:
        case ExtrapolationError():
            way = f"when looking up transform from frame [{error.source}] to frame [{error.target}]"
            extrapolation = ExtrapolationException(f"Lookup would require extrapolation {_missing(error)}, {way}")
            if error.requested_ns > error.newest_ns:
                latest = "write rclpy.time.Time() in place of the time: it asks for the latest transform"
                extrapolation.add_note(f"note: {latest}")
            return extrapolation
        case UnknownFrame():
            role = "target_frame" if error.frame == error.target else "source_frame"
            unknown = LookupException(f'"{error.frame}" passed to lookupTransform argument {role} does not exist. ')
            hint = str(error).partition(f"there is no frame {error.frame!r}")[2].lstrip("; ")
            again = "frames arrive while the node is spun: look it up in a timer, and catch tf2_ros.TransformException"
            unknown.add_note(f"note: {hint}; {again} until they are there")
            return unknown
        case FrameLoop():
            found = str(error).partition("loop: ")[2].partition(";")[0]
            return TransformException(f"The tf tree is invalid because it contains a loop: {found}")
    return ConnectivityException(
        f"Could not find a connection between '{error.target}' and '{error.source}' because they are not part of the "
        "same tree. Tf has two or more unconnected trees."
    )


def _missing(error: ExtrapolationError) -> str:
    requested, oldest, newest = map(_seconds, (error.requested_ns, error.oldest_ns, error.newest_ns))
    if error.oldest_ns == error.newest_ns:
        return f"at time {requested}, but only time {newest} is in the buffer"
    if error.requested_ns > error.newest_ns:
        return f"into the future.  Requested time {requested} but the latest data is at time {newest}"
    return f"into the past.  Requested time {requested} but the earliest data is at time {oldest}"


def _seconds(stamp: int) -> str:
    return f"{stamp // 10**9}.{stamp % 10**9 // 1000:06d}"
