"""Advice on TypeErrors of the constructors of messages and times.

The constructors of messages are written in C, and their errors do not name the class: it is read from the line of the
call.
"""

from __future__ import annotations

import ast
import linecache
import re
from types import FrameType, ModuleType, TracebackType

from graphflow import times
from graphflow.msgs.base import Action, Message, Service, name_of, no_field

_UNKNOWN = re.compile(r"Unexpected keyword argument '(\w+)'\Z")
_OF_TIMES = re.compile(
    rf"({'|'.join(times.FROM_SECONDS)})\.__init__\(\) got an unexpected keyword argument '(?:sec|seconds)'\Z"
)
_BY_POSITION = "Extra positional arguments provided"


def better_text(error: TypeError) -> str:
    """Return a better text for the error of such a constructor; "" for other errors."""
    if found := _OF_TIMES.match(str(error)):
        is_ours = _called(error.__traceback__) is vars(times)[found[1]]
        return f"{error}; write {times.FROM_SECONDS[found[1]]}" if is_ours else ""
    unknown = _UNKNOWN.match(str(error))
    if not unknown and str(error) != _BY_POSITION:
        return ""
    cls = _called(error.__traceback__)
    if not (isinstance(cls, type) and issubclass(cls, Message)):
        return ""
    if unknown:
        return no_field(cls, unknown[1])
    example = f"{cls.SCHEMA.fields[0].name}=..." if cls.SCHEMA.fields else ""
    return f"{name_of(cls)} takes its fields by keyword: {cls.__name__.rpartition('_')[2]}({example})"


def _called(trace: TracebackType | None) -> object:
    """Return the object whose call raised an error, if it has a name; else None."""
    if trace is None:
        return None
    while trace.tb_next is not None:
        trace = trace.tb_next
    # One entry per code unit, of two bytes; columns count bytes of UTF-8.
    line, end_line, start, end = list(trace.tb_frame.f_code.co_positions())[trace.tb_lasti // 2]
    if line is None or end_line is None:
        return None
    lines = linecache.getlines(trace.tb_frame.f_code.co_filename, trace.tb_frame.f_globals)[line - 1 : end_line]
    encoded = [text.encode() for text in lines]
    if not encoded:
        return None
    encoded[-1] = encoded[-1][:end]
    encoded[0] = encoded[0][start:]
    try:
        call = ast.parse(b"(" + b"".join(encoded) + b")", mode="eval").body
    except SyntaxError:  # the file has changed since
        return None
    return _named(call.func, trace.tb_frame) if isinstance(call, ast.Call) else None


def _named(expression: ast.expr, frame: FrameType) -> object:
    """Return the value of a possibly dotted name in a module, without running user code."""
    match expression:
        case ast.Name(name):
            return frame.f_globals.get(name)
        case ast.Attribute(owner, name):
            thing = _named(owner, frame)
            is_plain = isinstance(thing, ModuleType) or (
                isinstance(thing, type) and issubclass(thing, (Message, Service, Action))
            )
            return vars(thing).get(name) if is_plain else None
    return None
