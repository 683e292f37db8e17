"""Imports of names with a hyphen, which Python reads as a minus sign and refuses as invalid syntax."""

from __future__ import annotations

import re

_IMPORT = re.compile(r"\s*(?:from|import)\s+([\w.]*\w-\w[\w.-]*)")


def hyphen_hint(line: str) -> str:
    """Return the correction of a line that imports a name with a hyphen; empty for any other line."""
    found = _IMPORT.match(line)
    if found is None:
        return ""
    names = ", ".join(f"{name} to {name.replace('-', '_')}" for name in found[1].split(".") if "-" in name)
    return f"; Python imports no name with a hyphen: rename {names}, here and as a folder"
