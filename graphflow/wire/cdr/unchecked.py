"""Makes messages of values that need no check, such as those that a decoder has just read.

The constructor of a message class checks what it is given. A class of the same fields without checks makes the object,
which then becomes one of the message class: both are structs of the same layout.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from msgspec import Struct, defstruct

LENT = "_lent"
"""The attribute of a message that has its lent arrays, by field; see `wire.lending`."""


@cache
def unchecked_class(cls: Any) -> type[Struct]:
    """A class that takes the fields of a message class by position, and checks nothing.

    Assign the message class to the `__class__` of what it makes.
    """
    made = next(base for base in cls.__mro__ if "SCHEMA" in base.__dict__)  # subclasses of the user's add no fields
    fields = [(name, Any, None) if name == LENT else (name, Any) for name in made.__struct_fields__]
    return defstruct(made.__name__, fields, bases=made.__bases__, eq=False)


def unchecked(cls: Any, *values: Any) -> Any:
    """A message of a class, with the values of its fields in their order."""
    message: Any = unchecked_class(cls)(*values)
    message.__class__ = cls
    return message
