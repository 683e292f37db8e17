"""Files beside a program that hide modules of Python: with a `queue.py` there, `import queue` imports that file.

Imported when an import of graphflow's has failed, perhaps half-way: it needs nothing but `sys` and `os`.
"""

from __future__ import annotations

import os
import sys

_HIDES = " hides Python's module "


def hiding_file(error: Exception) -> str:
    """Return a message about a file in the program's folder that was imported as a module of Python; "" if none was.

    Args:
        error: The error of the import; its own text if it is such a message, from an import within the import.
    """
    if _HIDES in str(error):
        return str(error)
    folder = _folder_of_program()
    for name in sys.stdlib_module_names if folder else ():
        file = getattr(sys.modules.get(name), "__file__", None)
        if file is None or os.path.realpath(_importable(file)) != folder:
            continue
        shown = os.path.relpath(file)
        return f"{shown}{_HIDES}{name}: rename it, as in my_{os.path.basename(_importable(file, 0))}"
    return ""


def _folder_of_program() -> str:
    """Return the folder of the file that is run as a program, from which it imports; "" if there is none."""
    file = getattr(sys.modules.get("__main__"), "__file__", None)
    folder = os.path.realpath(os.path.dirname(file)) if file else ""
    return folder if sys.path and os.path.realpath(sys.path[0]) == folder else ""


def _importable(file: str, up: int = 1) -> str:
    """Return the folder of a module's file, or of the package whose `__init__.py` it is."""
    up += os.path.basename(file) == "__init__.py"
    for _ in range(up):
        file = os.path.dirname(file)
    return file
