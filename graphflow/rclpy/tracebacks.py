"""Tracebacks of programs, without the frames by which graphflow runs their callbacks."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from types import TracebackType

from graphflow.deadlock.user_code import is_ours, is_users


def install() -> None:
    """Show errors that end the program or one of its threads this way; nothing where a hook of others is installed."""
    if sys.excepthook is sys.__excepthook__:
        sys.excepthook = _show
    if threading.excepthook is threading.__excepthook__:
        threading.excepthook = _show_in_thread


def shorten(error: BaseException) -> None:
    """Leave in an error's traceback, and in those of the errors that led to it, what helps the program's author.

    The user's own frames stay. Of the others those stay that show where an error was raised, unless its text is enough:
    KeyboardInterrupt, SyntaxError, and the errors of rclpy's own.
    """
    seen = set[int]()
    following: BaseException | None = error
    while following is not None and id(following) not in seen:
        seen.add(id(following))
        following.__traceback__ = _shortened(following)
        following = following.__cause__ or following.__context__


def _shortened(error: BaseException) -> TracebackType | None:
    parts = list(_parts(error.__traceback__))
    own = [place for place, part in enumerate(parts) if is_users(part.tb_frame.f_code.co_filename)]
    if _is_clear(error):
        kept = [parts[place] for place in own]
    elif own:
        kept = [p for place, p in enumerate(parts) if place > own[-1] or (place >= own[0] and not _is_ours(p))]
    else:
        kept = parts
    shown: TracebackType | None = None
    for part in reversed(kept):
        shown = TracebackType(shown, part.tb_frame, part.tb_lasti, part.tb_lineno)
    return shown


def _parts(trace: TracebackType | None) -> Iterator[TracebackType]:
    while trace is not None:
        yield trace
        trace = trace.tb_next


def _is_ours(part: TracebackType) -> bool:
    return is_ours(part.tb_frame.f_code.co_filename)


def _is_clear(error: BaseException) -> bool:
    """Whether the place in graphflow's code where an error was raised tells nothing."""
    return isinstance(error, (KeyboardInterrupt, SyntaxError)) or type(error).__module__.startswith("rclpy.")


def _show(kind: type[BaseException], error: BaseException, _: TracebackType | None) -> None:
    shorten(error)
    sys.__excepthook__(kind, error, error.__traceback__)


def _show_in_thread(args: threading.ExceptHookArgs) -> None:
    error = args.exc_value
    if error is not None:
        shorten(error)
        args = threading.ExceptHookArgs((args.exc_type, error, error.__traceback__, args.thread))
    threading.__excepthook__(args)
