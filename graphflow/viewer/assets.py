"""The files that viewers ask for: meshes and textures of robots' descriptions, in packages.

Only `package://PACKAGE/...` is served, only files with the endings of meshes and pictures, and only below the folder of
their package: a viewer may be on another machine.
"""

from __future__ import annotations

import os
from pathlib import Path

from graphflow.errors import UsageFault, printable
from graphflow.reading import found_bytes
from graphflow.workspace.executables import package_share

SCHEME = "package://"
ENDINGS = (".stl", ".dae", ".obj", ".mtl", ".glb", ".gltf", ".bin", ".png", ".jpg", ".jpeg", ".urdf", ".xacro")
ASSET_BOUND = 15 << 20
"""The size of a file in bytes, at most: less than a viewer may leave unread."""


def asset(uri: str, here: Path) -> bytes:
    """Read a file that a viewer asks for.

    Args:
        here: The folder from which packages are searched.

    Raises:
        UsageFault: It is none of those above, does not exist, or is too large; the text is for the viewer.
    """
    shown = printable(uri[:200])
    package, _, rest = uri.removeprefix(SCHEME).partition("/")
    if not uri.startswith(SCHEME) or not package or not rest:
        raise UsageFault(f"{shown}: only files of packages are served: package://PACKAGE/FILE")
    if not rest.lower().endswith(ENDINGS):
        raise UsageFault(f"{shown}: only meshes and pictures are served: {', '.join(ENDINGS)}")
    share = package_share(package, here, os.environ)
    if share is None:
        raise UsageFault(f"{shown}: there is no package {printable(package)!r} here")
    root = share.resolve()
    file = (root / rest).resolve()
    if not file.is_relative_to(root):
        raise UsageFault(f"{shown}: the file is outside its package")
    try:
        return found_bytes(file, ASSET_BOUND)
    except OSError as error:
        raise UsageFault(f"{shown}: {error.strerror or error}") from None
