"""What tests of graph files share."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture
def lamps(tmp_path: Path) -> Path:
    """A workspace with a package that has a function, one whose module is gone, and a program as executables."""
    folder = tmp_path / "src" / "lamp"
    (folder / "lamp").mkdir(parents=True)
    (folder / "scripts").mkdir()
    (folder / "package.xml").write_text("<package><name>lamp</name></package>")
    (folder / "setup.py").write_text("setup(entry_points={'console_scripts': ['shine = lamp.a:main', 'b = lamp.b:f']})")
    (folder / "CMakeLists.txt").write_text("add_executable(glow src/glow.cpp)")
    (folder / "lamp" / "a.py").write_text("import rclpy\ndef main(): ...\n")
    (folder / "scripts" / "blink.py").write_text("import rclpy\n")
    (tmp_path / "p.yaml").write_text("/**: {ros__parameters: {level: 2}}\n")
    return tmp_path
