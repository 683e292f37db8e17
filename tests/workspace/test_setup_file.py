"""`setup.py` as it is read, and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.workspace.setup_file import EntryPoint, SetupFile, function_fault

SETUP = """\
from setuptools import setup

setup(
    name="lamp",
    entry_points={
        "console_scripts": [
            "one = lamp.one:main",
            "two = lamp.two:main",
        ],
    },
)
"""


def test_executables_and_their_lines() -> None:
    """Are known without running it; a file that is not there has none."""
    found = SetupFile(Path("setup.py"), SETUP)
    assert found.entry_points == {"one": EntryPoint("lamp.one", "main"), "two": EntryPoint("lamp.two", "main")}
    assert found.lines == {"one": 7, "two": 8}
    assert found.faults == []
    assert SetupFile(Path("setup.py"), "").faults == []


def test_an_executable_without_its_function(tmp_path: Path) -> None:
    """Its module is there: main is meant."""
    (tmp_path / "lamp").mkdir()
    (tmp_path / "lamp" / "one.py").touch()
    [fault] = SetupFile(tmp_path / "setup.py", SETUP.replace("one:main", "one")).faults
    assert fault.endswith("'one = lamp.one' names no function; did you mean 'one = lamp.one:main'?")


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ('"lamp",', '"lamp"', "setup.py:4: SyntaxError: invalid syntax. Perhaps you forgot a comma?"),
        ("entry_points", "entry_point", "setup.py:5: setup() has no argument 'entry_point'; did you mean 'entry_poi"),
        ("console_scripts", "console_script", "setup.py:6: nobody reads the group 'console_script'; did you mean"),
        ('one:main",', 'one:main"', "setup.py:7: 'one = lamp.one:maintwo = lamp.two:main' is one text: a comma is mis"),
        ("lamp.one", "lamp/one", "setup.py:7: 'one = lamp/one:main' names no function; did you mean 'one = lamp.one:m"),
        ("one:main", "one.main", "setup.py:7: 'one = lamp.one.main' names no function; did you mean 'one = lamp.one:m"),
        (
            "one:main",
            "one:main()",
            "setup.py:7: 'one = lamp.one:main()' names no function; did you mean 'one = lamp.one:main'",
        ),
        (
            "one = lamp",
            "one: lamp",
            "setup.py:7: 'one: lamp.one:main' names no function; did you mean 'one = lamp.one:m",
        ),
        ("two = ", "one = ", "setup.py:8: 'one' is the name of the executable in line 7, too; rename one of them"),
        (
            "entry_points=",
            "data_files=[('a', glob('a/*'))], entry_points=",
            "setup.py:5: glob is not imported; write at the top: from glob import glob",
        ),
        (
            "entry_points=",
            "data_files=[(os.path.join('a', 'b'), [])], entry_points=",
            "setup.py:5: os is not imported; write at the top: import os",
        ),
        (
            "entry_points=",
            "data_files=[('a', [])('b', [])], entry_points=",
            "setup.py:5: a comma is missing between two tuples of the list",
        ),
        ("one = lamp.one:main", "lamp", "setup.py:7: 'lamp' names no function; write 'NAME = PACKAGE.MODULE:FUNCTION'"),
    ],
)
def test_faults_have_their_line(right: str, wrong: str, told: str) -> None:
    """And say what is wrong there."""
    [fault] = SetupFile(Path("setup.py"), SETUP.replace(right, wrong)).faults
    assert fault.startswith(told)


@pytest.mark.parametrize("text", ["\0", "\ud800"])
def test_what_is_no_text(text: str) -> None:
    """Is told as any other fault."""
    [fault] = SetupFile(Path("setup.py"), text).faults
    assert fault.startswith("setup.py:1: SyntaxError: ")


def test_names_of_its_own() -> None:
    """Stand for their texts; what is not plain to see is known to be missing."""
    found = SetupFile(
        Path("setup.py"), 'NAME = "lamp"\n' + SETUP.replace('"one = lamp.one:main"', '"one = " + NAME + ".one:main"')
    )
    assert found.entry_points["one"] == EntryPoint("lamp.one", "main")
    assert not found.computes_scripts
    computed = SetupFile(Path("setup.py"), SETUP.replace('"one = lamp.one:main"', "made()"))
    assert computed.computes_scripts
    assert [*computed.entry_points] == ["two"]


@pytest.mark.parametrize(
    ("call", "line"), [("find_packages()", 2), ("setuptools.find_packages()", 2), ("found()", None)]
)
def test_finding_packages(call: str, line: int | None) -> None:
    """By its name alone, or by that of its module, too."""
    assert SetupFile(Path("setup.py"), f"import setuptools\nfound = {call}\n").finds_packages == line


def test_executables_of_a_computed_list() -> None:
    """Are found wherever they stand, as the folder of the modules is."""
    text = 'from setuptools import setup\nONE = "one = lamp.one:main"\n'
    text += 'setup(package_dir={"": "src"}, entry_points={"console_scripts": sorted(ONE)})\n'
    found = SetupFile(Path("setup.py"), text)
    assert [*found.entry_points] == ["one"]
    assert found.package_dir == "src"


@pytest.mark.parametrize(
    ("written", "folder", "renamed"),
    [
        ("{'': 'src'}", "src", {}),
        ("{'': 'lib', 'lamp': 'src/lamp'}", "lib", {}),
        ("{'lamp': 'src/lamp'}", "src", {}),
        ("{'lamp': 'lib'}", ".", {"lamp": Path("lib")}),
        ("{**more}", ".", {}),
    ],
)
def test_where_packages_are(written: str, folder: str, renamed: dict[str, Path]) -> None:
    """All in one folder, or one by its name; a folder of another name than its package's is known as such."""
    found = SetupFile(Path("setup.py"), f"setup(package_dir={written})")
    assert (found.package_dir, found.renamed) == (folder, renamed)


MODULE = """\
from elsewhere import imported as start

class Lamp: ...

def main(): ...

if start:
    run = main
"""


@pytest.mark.parametrize(
    ("function", "told"),
    [
        ("main", None),
        ("start", None),
        ("run", None),
        ("Lamp.spin", None),
        ("mian", "one.py has no function 'mian'; did you mean 'main'?"),
        ("elsewhere", "one.py has no function 'elsewhere'; there is main"),
        ("Lamp", "Lamp is a class: name a function that makes one and spins it, such as main"),
    ],
)
def test_functions_that_a_module_has_not(function: str, told: str | None) -> None:
    """Are seen without importing it."""
    assert function_fault(EntryPoint("lamp.one", function), Path("one.py"), MODULE) == told


@pytest.mark.parametrize(
    "source",
    [
        "from lamp import *",
        "def __getattr__(name): ...",
        "def main(:",
        "globals()['main'] = print",
        "def make():\n    global main\n    main = print\nmake()",
        "from lamp.two import run as main",
        "main, other = print, None",
        "if True:\n    main = lambda: None",
    ],
)
def test_functions_that_only_an_import_shows(source: str) -> None:
    """Are not missed."""
    assert function_fault(EntryPoint("lamp.one", "main"), Path("one.py"), source) is None
