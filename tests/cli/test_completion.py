"""`graphflow completion` in real shells."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.cli.completing import SCRIPTS
from graphflow.cli.completion import split_line
from tests.cases import slow
from tests.conftest import Machine


@pytest.mark.parametrize(
    ("line", "words", "partial"),
    [
        ("graphflow", [], "graphflow"),
        ("graphflow ", ["graphflow"], ""),
        ("gf topic e", ["gf", "topic"], "e"),
        ("gf topic pub /a T '", ["gf", "topic", "pub", "/a", "T"], "'"),
        ("gf topic pub /a T '{x: 1", ["gf", "topic", "pub", "/a", "T"], "'{x: 1"),
        ("gf topic pub /a T 'b c' ", ["gf", "topic", "pub", "/a", "T", "b c"], ""),
        ("", [], ""),
        ("it's gone ", ["it's", "gone"], ""),
    ],
)
def test_a_line_is_parted(line: str, words: list[str], partial: str) -> None:
    """A line is split as by a shell; an unclosed quotation is the last word."""
    assert split_line(line) == (words, partial)


BASH = """
PATH={path}:$PATH
. {script}
line={line!r}
COMP_LINE="$line"; COMP_POINT=${{#line}}; read -ra COMP_WORDS <<< "$line"
[[ "$line" == *" " ]] && COMP_WORDS+=("")
COMP_CWORD=$((${{#COMP_WORDS[@]}}-1)); _graphflow; printf '%s\\n' "${{COMPREPLY[@]}}"
[[ $- == *f* ]] && echo "it left the shell without patterns" || true
"""


@slow
@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("graphflow topic ec", ["echo"]),
        ("gf interface show std_msgs/msg/Strin", ["std_msgs/msg/String"]),
        ("graphflow topic pub /a std_msgs/msg/String '", ["'{data: ''}'"]),
    ],
)
def test_bash(machine: Machine, tmp_path: Path, line: str, found: list[str]) -> None:
    """The script passes completions on unchanged, including spaces."""
    script = tmp_path / "script"
    script.write_text(SCRIPTS["bash"])
    text = BASH.format(path=Path(sys.executable).parent, script=script, line=line)
    told = subprocess.run(["bash", "-c", text], env=machine.env, capture_output=True, text=True, timeout=30, check=True)
    assert told.stdout.splitlines() == found


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_read_theirs(shell: str, tmp_path: Path) -> None:
    """zsh and fish load the script without errors, where they are installed."""
    if shutil.which(shell) is None:
        pytest.skip(f"there is no {shell}")
    (tmp_path / "script").write_text(SCRIPTS[shell])
    subprocess.run([shell, "-n", str(tmp_path / "script")], check=True, timeout=30)


@pytest.mark.parametrize("shell", list(SCRIPTS))
def test_install(machine: Machine, tmp_path: Path, shell: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """`install` finds the shell from the environment, and prints what remains to be done."""
    monkeypatch.setitem(machine.env, "HOME", str(tmp_path))
    monkeypatch.setitem(machine.env, "SHELL", f"/usr/bin/{shell}")
    text = machine.look("completion", "install")
    file = Path(text.splitlines()[0])
    assert file.is_relative_to(tmp_path)
    assert file.read_text() == SCRIPTS[shell] == machine.look("completion", "show", shell).removesuffix("\n")


def test_a_shell_that_is_not_known(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    """Must be named."""
    monkeypatch.setitem(machine.env, "SHELL", "/bin/dash")
    told = "name the shell: graphflow completion install bash|zsh|fish"
    assert told in machine.look("completion", "install", code=2)


@pytest.mark.skipif(shutil.which("fish") is None, reason="there is no fish")
@pytest.mark.parametrize(
    ("line", "found"), [("graphflow topic ec", "echo"), ("gf topic pub /a std_msgs/msg/String '", "'{data: ''}'")]
)
def test_fish(machine: Machine, tmp_path: Path, line: str, found: str) -> None:
    """The same in fish."""
    script = tmp_path / "script.fish"
    path = f"set -x PATH {Path(sys.executable).parent} $PATH\n"
    script.write_text(f'{path}{SCRIPTS["fish"]}\ncomplete -C "{line}"\n')
    told = subprocess.run(
        ["fish", "-N", script], env=machine.env, capture_output=True, text=True, timeout=30, check=True
    )
    assert told.stdout.splitlines()[:1] == [found]
