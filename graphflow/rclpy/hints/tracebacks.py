"""Tracebacks of programs, without the frames in which graphflow runs their callbacks."""

from __future__ import annotations

import atexit
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Any

from graphflow.analysis.user_code import is_installed, is_ours, is_refusal, is_users, parts_of
from graphflow.rclpy.hints import lookup
from graphflow.runtime.callables import file_of
from graphflow.runtime.mistakes.errors.attribute_errors import explain


def install() -> None:
    """Install a hook that shortens uncaught errors of the program and its threads; keep another's hook."""
    if sys.excepthook is sys.__excepthook__:
        sys.excepthook = show
    install_in_threads()


def advise_at_exit() -> None:
    """Print the next step at exit for an error before `install`, as of an import, which Python prints as it is.

    In the user's own program alone: pytest and others keep the errors that they have reported themselves.
    """
    file = file_of(sys.modules.get("__main__"))  # the attribute is gone at exit
    if file and not (sys.flags.interactive or is_ours(file) or is_installed(file)):
        atexit.register(_at_exit)


def _at_exit() -> None:
    error = getattr(sys, "last_value", None)
    if error is not None and sys.excepthook is sys.__excepthook__ and (found := lookup.hint(error)):
        sys.stderr.write(f"note: {found}\n")


def install_in_threads() -> None:
    """Install a hook that shortens errors that end a thread; keep another's hook."""
    if threading.excepthook is threading.__excepthook__:
        threading.excepthook = _show_in_thread


def shorten(error: BaseException) -> None:
    """Drop graphflow's frames from an error's traceback and those of its causes, and add the next step as a note.

    The user's own frames stay, and so do the frames that show where an error was raised, unless its text is enough:
    KeyboardInterrupt, SyntaxError, rclpy's own errors, those that graphflow raises itself, and those with a next
    step.
    """
    explain(error)
    hint = "" if isinstance(error, KeyboardInterrupt) else lookup.hint(error)
    note = f"note: {hint}"
    if hint and note not in getattr(error, "__notes__", ()):
        error.add_note(note)
    if hint and isinstance(error, (AttributeError, NameError)):
        error.name = None  # Python would add a guess of its own
    seen = set[int]()
    following: BaseException | None = error
    while following is not None and id(following) not in seen:
        seen.add(id(following))
        following.__traceback__ = _shortened(following, is_clear=bool(hint) and following is error)
        following = following.__cause__ or following.__context__


def _shortened(error: BaseException, *, is_clear: bool) -> TracebackType | None:
    parts = list(parts_of(error.__traceback__))
    own = [place for place, part in enumerate(parts) if is_users(part.tb_frame.f_code.co_filename)]
    if is_clear or _is_redundant(error) or (own and is_refusal(parts[-1], "assert")):
        kept = [parts[place] for place in own]
    elif own:
        kept = [p for place, p in enumerate(parts) if place > own[-1] or (place >= own[0] and not _is_ours(p))]
    else:
        kept = parts
    shown: TracebackType | None = None
    for part in reversed(kept):
        shown = TracebackType(shown, part.tb_frame, part.tb_lasti, part.tb_lineno)
    return shown


def _is_ours(part: TracebackType) -> bool:
    return is_ours(part.tb_frame.f_code.co_filename)


def _is_redundant(error: BaseException) -> bool:
    """Whether the frame in graphflow that raised an error adds no information."""
    return isinstance(error, (KeyboardInterrupt, SyntaxError)) or type(error).__module__.startswith("rclpy.")


def show(kind: type[BaseException], error: BaseException, _: TracebackType | None = None) -> None:
    """Print an uncaught error, shortened, with its next step; further interrupts are ignored meanwhile."""
    with _without_interrupts():
        shorten(error)
        sys.__excepthook__(kind, error, error.__traceback__)


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Ignore Ctrl-C, which is often pressed twice: it would cut the text short."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    former = _handle_interrupts(signal.SIG_IGN)
    try:
        yield
    finally:
        _handle_interrupts(former)


def _handle_interrupts(handler: Any) -> Any:
    """Set the handler of SIGINT; returns the former one, None if it was not set from Python."""
    while True:
        with suppress(KeyboardInterrupt):  # of a signal that came just before
            return signal.signal(signal.SIGINT, signal.SIG_DFL if handler is None else handler)


def _show_in_thread(args: threading.ExceptHookArgs) -> None:
    error = args.exc_value
    if error is not None:
        shorten(error)
        args = threading.ExceptHookArgs((args.exc_type, error, error.__traceback__, args.thread))
    threading.__excepthook__(args)
