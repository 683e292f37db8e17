"""The state of a launch file while it runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.launchfiles.python.recording import PackageNotFoundError, Recording, as_text
from graphflow.markup.substitutions import SubstitutionError


def test_configurations_are_texts() -> None:
    """Texts stay as they are; other values are written as JSON."""
    assert [as_text(value) for value in ("True", True, 2.5)] == ["True", "true", "2.5"]


def test_values_of_a_file_that_is_started() -> None:
    """A given argument wins over its default, and a value that was set over both."""
    recording = Recording()
    recording.values, recording.file = {"a": "1"}, "/lab/a.launch.py"
    recording.defaults = {"a": "0", "b": "$(var a)2"}
    assert recording.known("$(var a) $(var b)") == "1 12"
    recording.set["a"] = "3"
    assert recording.known("$(var a)") == "3"
    recording.needed.add("c")
    with pytest.raises(SubstitutionError, match="'c' has no default; give c:=VALUE"):
        recording.known("$(var c)")


def test_a_file_that_is_converted() -> None:
    """Substitutions stay, also those for folders of packages."""
    recording = Recording()
    assert recording.known("$(var a)") == "$(var a)"
    assert recording.folder("share", "nowhere") == "$(find-pkg-share nowhere)"


def test_folders_of_packages(tmp_path: Path) -> None:
    """A package that is not there is an error that says so."""
    (tmp_path / "package.xml").write_text("<package><name>robot</name></package>")
    recording = Recording()
    recording.values, recording.file = {}, str(tmp_path / "a.launch.py")
    assert recording.folder("prefix", "robot") == str(tmp_path)
    with pytest.raises(PackageNotFoundError, match="package 'nowhere' not found"):
        recording.folder("share", "nowhere")


def test_lines() -> None:
    """The line is that of the file; 1 outside of it."""
    recording = Recording()
    assert recording.line() == 1
    recording.file = __file__
    first, second = recording.line(), recording.line()
    assert (first, second) == (first, first)
    assert first > 1
