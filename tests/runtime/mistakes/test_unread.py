"""Unused arguments of a command line."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from graphflow import Node
from graphflow.runtime.mistakes.unread import unread

FILE = "pass a parameter file with --params-file"
Make = Callable[[str], type[Node]]
PLAIN = """\
from graphflow import Node, Param


class Talk(Node):
    rate = Param(2.0)
    max_speed = Param(1.0)
"""


@pytest.fixture
def talk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Make:
    """Makes the class `Talk` of a module with this text, in a process that has no other."""

    def made(text: str) -> type[Node]:
        file = tmp_path / "talk.py"
        file.write_text(text)
        spec = importlib.util.spec_from_file_location("talk", file)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, "talk", module)
            spec.loader.exec_module(module)
        main = ModuleType("__main__")
        main.__file__ = str(file)
        known = {"graphflow", *sys.stdlib_module_names}
        others = {name: module for name, module in sys.modules.items() if name.partition(".")[0] in known}
        monkeypatch.setattr(sys, "modules", {**others, "talk": module, "__main__": main})
        return module.Talk  # type: ignore[no-any-return]

    return made


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], ""),
        (["Talk"], "Talk is a class, not an argument; write graphflow run talk:Talk"),
        (["--rate", "1.0"], "nothing reads the option '--rate'; to set the parameter write -p rate:=1.0"),
        (["--rate=1.0"], "nothing reads the option '--rate=1.0'; to set the parameter write -p rate:=1.0"),
        (["rate=1.0"], "nothing reads the argument 'rate=1.0'; to set the parameter write -p rate:=1.0"),
        (["--rate", "--json"], "nothing reads the option '--rate'; to set the parameter write -p rate:=VALUE"),
        (["--max-speed"], "nothing reads the option '--max-speed'; to set the parameter write -p max_speed:=VALUE"),
        (
            ["--params", "a.yaml"],
            "nothing reads the option '--params'; pass a parameter file with --params-file a.yaml",
        ),
        (["-f", "a.yml"], "nothing reads the option '-f'; pass a parameter file with --params-file a.yml"),
        (
            ["--params-file=a.yaml"],
            "nothing reads the option '--params-file'; pass a parameter file with --params-file a.yaml",
        ),
        (
            ["--config", "a.json"],
            "nothing reads the option '--config'; -p NAME:=VALUE sets a parameter: rate, max_speed",
        ),
        (["--name", "a"], "nothing reads the option '--name'; write -r __node:=a"),
        (["--ns=/a"], "nothing reads the option '--ns'; write -r __ns:=/a"),
        (["--debug"], "nothing reads the option '--debug'; write --log-level debug"),
        (["--json"], "nothing reads the option '--json'; -p NAME:=VALUE sets a parameter: rate, max_speed"),
    ],
)
@pytest.mark.parametrize("is_own_program", [True, False])
def test_words_that_nothing_reads(talk: Make, words: list[str], told: str, is_own_program: bool) -> None:
    """They are reported, with the parameter that seems meant."""
    cls = talk(PLAIN)
    assert unread(words, [cls], is_own_program=is_own_program) == told


@pytest.mark.parametrize("line", ["import argparse", "import sys\nWORDS = sys.argv[1:]", "from argparse import *"])
def test_a_program_that_reads_its_words(talk: Make, line: str) -> None:
    """Keeps them."""
    cls = talk(f"{line}\n{PLAIN}")
    assert unread(["--rate", "1.0"], [cls], is_own_program=True) == ""
    assert unread(["--rate", "1.0"], [cls], is_own_program=False) == ""


def test_an_installed_program(talk: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    """Such as pytest, by which nodes are run, may read its words; `graphflow run` is one, and does not."""
    cls = talk(PLAIN)
    main = sys.modules["__main__"]
    monkeypatch.setattr(main, "__file__", "/usr/lib/python3/site-packages/pytest/__main__.py")
    assert unread(["--rate"], [cls], is_own_program=True) == ""
    assert unread(["--rate"], [cls], is_own_program=False) != ""


def test_a_program_without_a_file(talk: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    """`python -c` has no file to check, and may read its arguments."""
    cls = talk(PLAIN)
    monkeypatch.delattr(sys.modules["__main__"], "__file__")
    assert unread(["--rate"], [cls], is_own_program=True) == ""


@pytest.mark.parametrize("line", ["import cli_of_ours", "from cli_of_ours import options"])
def test_an_installed_module_that_reads_them(
    talk: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, line: str
) -> None:
    """Such as a company's own, which a program imports: it keeps them."""
    file = tmp_path / "site-packages" / "cli_of_ours.py"
    file.parent.mkdir()
    file.write_text("import argparse\ndef options(): ...\n")
    monkeypatch.syspath_prepend(str(file.parent))
    installed = importlib.import_module("cli_of_ours")
    monkeypatch.delitem(sys.modules, "cli_of_ours")
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "cli_of_ours", installed)
        cls = talk(f"{line}\n{PLAIN}")
    monkeypatch.setitem(sys.modules, "cli_of_ours", installed)
    assert unread(["--rate"], [cls], is_own_program=False) == ""
