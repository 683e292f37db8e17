"""Suggestions for a path at which there is no bag."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

from graphflow.bag.formats import metadata
from graphflow.names import nearest

_ENDINGS = (".mcap", ".db3", ".bag")
_SHOWN = 5
LOOKED_AT = 1000
"""Largest number of entries of a folder that are read."""


def suggestion(path: Path) -> str:
    """Return advice on a path at which there is no bag: the bag that may be meant, or the bags beside it."""
    try:
        found = sorted(islice(filter(_is_bag, path.parent.iterdir()), LOOKED_AT))
    except OSError:
        return ""
    names = {bag.name: bag for bag in found} | {bag.stem: bag for bag in found}
    best = nearest(path.name, names) or nearest(path.stem, names)
    if best is not None:
        return f"; did you mean {str(names[best])!r}?"
    folders = [bag for bag in found if bag.is_dir()] or found
    return f"; there is {', '.join(map(str, folders))}" if 0 < len(folders) <= _SHOWN else ""


def _is_bag(path: Path) -> bool:
    return path.suffix in _ENDINGS or (path / metadata.FILE).is_file() or any(path.glob("*.mcap"))
