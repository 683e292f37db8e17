"""Creation of messages from values that need no check, as those of a decoder.

The constructor of a message class checks its arguments. A twin class with the same fields and no checks creates the
object, whose class is then changed to the message class: both are structs of the same layout.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from msgspec import Struct, defstruct

LENT = "_lent"
"""The attribute of a message with its lent arrays by field; see `wire.cdr.lending`."""


@cache
def unchecked_class(cls: Any) -> type[Struct]:
    """Return a class that takes the fields of a message class by position, without checks.

    Assign the message class to the `__class__` of its instances.
    """
    made = next(base for base in cls.__mro__ if "SCHEMA" in base.__dict__)  # a user's subclasses add no fields
    fields = [(name, Any, None) if name == LENT else (name, Any) for name in made.__struct_fields__]
    return defstruct(made.__name__, fields, bases=made.__bases__, eq=False)


def unchecked(cls: Any, *values: Any) -> Any:
    """Create a message from the values of its fields, in their order."""
    message: Any = unchecked_class(cls)(*values)
    message.__class__ = cls
    return message
