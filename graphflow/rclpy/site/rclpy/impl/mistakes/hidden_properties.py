"""Methods of a node's class that have the name of a property of every node, such as `handle`, which they hide."""

from __future__ import annotations

import inspect

from graphflow.analysis.user_code import short_place
from graphflow.runtime.callables import code_of


def refuse_hidden_properties(cls: type, base: type) -> None:
    """Check that a class hides no property of its base.

    Raises:
        AttributeError: It does; the text has the method and its line.
    """
    for name in (name for name, own in vars(base).items() if isinstance(own, property)):
        found = inspect.getattr_static(cls, name)
        if not isinstance(found, property):
            code = code_of(found)
            where = f" ({short_place(code.co_filename, code.co_firstlineno)})" if code is not None else ""
            raise AttributeError(f"every node has {name!r} already: choose another name in {cls.__name__}{where}")
