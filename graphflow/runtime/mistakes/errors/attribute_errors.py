"""Advice on AttributeErrors, added to their texts when they are reported.

A `__getattr__` in the classes would make each attribute access seven times slower on Python 3.11.
"""

from __future__ import annotations

import dis
import inspect
import linecache
import logging
import re
from collections.abc import Collection
from types import CodeType, FrameType

from graphflow.analysis.user_code import is_users, parts_of, short_place
from graphflow.msgs.base import Message, no_field
from graphflow.names import nearest
from graphflow.runtime.callables import code_of
from graphflow.runtime.mistakes.errors import constructor_errors
from graphflow.runtime.mistakes.hooks import hook_meant
from graphflow.runtime.mistakes.rclpy_words import AttributeHints, hint_of, text_instead, translation

_NO_ATTRIBUTE = re.compile(r"'(?P<kind>\w+)' object has no attribute '(?P<name>\w+)'(?P<more> and no __dict__ .*)?")
_PATH = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+")
"""A dotted name."""
_NO_PUBLISHER = "it is a logger, with info(...), warning(...) and error(...); self.log is that of the node"
_AXES = ("x", "y", "z")


def explain(error: BaseException) -> None:
    """Complete the texts of an error and of its causes, in place; texts other than Python's own stay."""
    left, seen = [error], set[int]()
    while left:
        found = left.pop()
        if id(found) in seen:
            continue
        seen.add(id(found))
        left += [e for e in (found.__cause__, found.__context__) if e is not None]
        if isinstance(found, BaseExceptionGroup):
            left += found.exceptions
        # Subclasses are excluded: their texts may come from user code, which must not run here.
        if found.__class__ is AttributeError and (text := better_text(found)):
            found.args, found.name = (text,), None  # otherwise Python would add its own suggestion for the name
        elif found.__class__ is TypeError and (text := constructor_errors.better_text(found)):
            found.args = (text,)


def better_text(error: AttributeError) -> str:
    """Return a better text for an error; "" if Python's is good enough."""
    thing, name = (error.obj, error.name) if error.name is not None else _written_to(error)
    found = _NO_ATTRIBUTE.fullmatch(str(error))
    if thing is None or name is None or found is None or (found["kind"], found["name"]) != (type(thing).__name__, name):
        return ""
    if isinstance(thing, Message):
        return no_field(type(thing), name)
    if way := _of_transform(thing, name, error):
        return f"{error}; {way}"
    if isinstance(thing, logging.Logger):
        return f"{error}; {_near(thing, name) or _NO_PUBLISHER}"
    if not isinstance(thing, AttributeHints):  # Python has its suggestion only where it prints the error itself
        near = "" if type(thing).__module__.startswith("rclpy.") else _near(type(thing), name)  # has hints of its own
        return f"{error}; {near}" if near else ""
    if text := text_instead(thing, name):
        return text
    running = {part.tb_frame.f_code for part in parts_of(error.__traceback__)}
    own = translation(name) or _hint_with_name(thing, name, error)
    hint = own or _setter(thing, name, running) or _near(thing, name) or _first_value(name, error)
    return f"{error}; {hint}" if hint else ""


def _hint_with_name(thing: AttributeHints, name: str, error: AttributeError) -> str:
    """Return an object's hint, with the object as the user's line names it."""
    hint, parts = hint_of(thing, name), list(parts_of(error.__traceback__))
    if "IT" not in hint or not parts:
        return hint
    frame = parts[-1].tb_frame
    line = linecache.getline(frame.f_code.co_filename, parts[-1].tb_lineno)
    owners = (path.rpartition(".") for path in _PATH.findall(line))
    named = (owner for owner, _, attribute in owners if attribute == name and named_in(frame, owner) is thing)
    return re.sub(r"\bIT\b", next(named, "it"), hint)


def _of_transform(thing: object, name: str, error: AttributeError) -> str:
    """Return how the numbers of a transform are read, which are no fields as a message's are; "" for other objects."""
    kind = f"{type(thing).__module__}.{type(thing).__name__}"
    if kind == "graphflow.tf.transform.Transform" and name in _AXES:
        return "its numbers are a tuple: x, y, z = found.translation"
    parts = list(parts_of(error.__traceback__))
    if not isinstance(thing, tuple) or name not in (*_AXES, "w") or not parts:
        return ""
    line = linecache.getline(parts[-1].tb_frame.f_code.co_filename, parts[-1].tb_lineno)
    found = re.search(rf"([\w.]*\b(translation|rotation|rpy))\.{name}\b", line)
    return "" if found is None else f"it is a tuple: write {found[1]}[{'xyzw'.index(name)}]"


def _near(thing: object, name: str) -> str:
    """Return the attribute that a misspelt one seems to mean; "" if there is none."""
    near = nearest(name, [word for word in dir(thing) if not word.startswith("_")], cutoff=0.75)
    return f"did you mean {near!r}?" if near is not None else ""


def _first_value(name: str, error: AttributeError) -> str:
    """Return a hint if the line counts with an attribute that nothing sets; "" otherwise."""
    parts = list(parts_of(error.__traceback__))
    line = linecache.getline(parts[-1].tb_frame.f_code.co_filename, parts[-1].tb_lineno) if parts else ""
    counts = re.search(rf"self\.{name}\s*[-+*/]=", line) is not None
    return f"give it a first value in the class: {name} = 0" if counts else ""


def _setter(thing: object, name: str, running: Collection[CodeType]) -> str:
    """Return a hint with the method that sets an attribute and has not run yet; "" if there is none.

    Args:
        running: The functions that run now, which are no help.
    """
    for cls in type(thing).__mro__:
        for word, method in vars(cls).items():
            code = code_of(method)
            if code is None or word == "__init__" or code in running or not is_users(code.co_filename):
                continue
            if any(step.opname == "STORE_ATTR" and step.argval == name for step in dis.get_instructions(code)):
                where = f"{word} ({short_place(code.co_filename, code.co_firstlineno)})"
                if word.strip("_") == "init":
                    return f"{where} sets it, and nothing calls that: write __init__"
                if inspect.getattr_static(type(thing), word) is not method:
                    return f"{where} sets it, and {type(thing).__name__} replaces that: call super().{word}() there"
                if word.startswith("on_") and (meant := hook_meant(type(thing), word)):
                    return f"{where} sets it, and nothing calls that; {meant}"
                return f"{where} sets it, and has not run: have it called before, or write {name} = None in the class"
    return ""


def _written_to(error: AttributeError) -> tuple[object, str | None]:
    """Return the object and the attribute that a line sets; Python 3.11 records them only for reads."""
    found = _NO_ATTRIBUTE.fullmatch(str(error))
    parts = list(parts_of(error.__traceback__))
    if found is None or not parts:
        return None, None
    frame, line = parts[-1].tb_frame, linecache.getline(parts[-1].tb_frame.f_code.co_filename, parts[-1].tb_lineno)
    for path in _PATH.findall(line):
        owner, _, attribute = path.rpartition(".")
        thing = named_in(frame, owner) if attribute == found["name"] else None
        if type(thing).__name__ == found["kind"]:
            return thing, attribute
    return None, None


def named_in(frame: FrameType, path: str) -> object:
    """Return the object that a dotted name refers to in a frame; None if finding it would run user code."""
    first, *rest = path.split(".")
    thing = {**frame.f_globals, **frame.f_locals}.get(first)
    for part in rest:
        thing = getattr(thing, part, None) if isinstance(thing, Message) else getattr(thing, "__dict__", {}).get(part)
    return thing
