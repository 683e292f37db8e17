"""The substitution `$(command ...)` of graph files: the output of a program."""

from __future__ import annotations

import logging
import os
import shlex
import subprocess
from collections.abc import Mapping
from pathlib import Path

from graphflow.markup.substitutions import MAX_TEXT, SubstitutionError
from graphflow.system import SITE
from graphflow.workspace.executables import is_ros_sourced

logger = logging.getLogger("graphflow")

LIMIT = 30.0
"""Seconds that a program may take."""


def printed(words: list[str], on_stderr: str, folder: Path, env: Mapping[str, str]) -> str:
    """Run a program; returns its output.

    Args:
        words: The program and its arguments, which no shell reads.
        on_stderr: The treatment of its error output: one of `substitutions.ON_STDERR`.
        folder: Its working directory.
        env: Its environment.

    Raises:
        SubstitutionError: It cannot be started, fails, complains, takes too long or prints too much.
    """
    written = f"$(command {shlex.join(words)[:60]})"
    errors = subprocess.STDOUT if on_stderr == "capture" else subprocess.PIPE
    try:
        ended = subprocess.run(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            cwd=folder,
            env=_with_ros(env),
            timeout=LIMIT,
            check=False,
        )
        text = str(ended.stdout, "utf-8")
    except subprocess.TimeoutExpired:
        raise SubstitutionError(f"{written}: it has not ended within {LIMIT:g} s") from None
    except FileNotFoundError:
        hint = "; it is on PyPI: pip install xacro" if words[0] == "xacro" else ""
        raise SubstitutionError(f"{written}: there is no program {words[0]!r} on the PATH{hint}") from None
    except (OSError, ValueError) as error:
        raise SubstitutionError(f"{written}: {error}") from None
    complaint = (ended.stderr or b"").decode(errors="replace").strip()
    lines = complaint.splitlines()
    last = next((f": {line}" for line in lines if line.startswith("error: ")), f": {lines[-1]}" if lines else "")
    if ended.returncode:
        raise SubstitutionError(f"{written}: exit code {ended.returncode}{last}")
    if complaint and on_stderr == "fail":
        first = f": {lines[0]}" if len(lines) > 1 and lines[0] not in last else ""
        ways = "$(command '...' warn), or in Python Command([...], on_stderr='warn')"
        raise SubstitutionError(f"{written} wrote to its error output{first}{last}; to allow that: {ways}")
    if complaint and on_stderr == "warn":
        logger.warning("%s: %s", written, complaint)
    if len(text) > MAX_TEXT:
        raise SubstitutionError(f"{written}: it printed more than {MAX_TEXT:,} characters")
    return text


def _with_ros(env: Mapping[str, str]) -> dict[str, str]:
    """Extend an environment by graphflow's ament_index_python, which programs such as xacro import."""
    if is_ros_sourced(env):
        return dict(env)
    return {**env, "PYTHONPATH": os.pathsep.join(filter(None, [env.get("PYTHONPATH"), SITE]))}
