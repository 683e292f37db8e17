"""Modules that run nodes while they are imported for their classes."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import UsageFault
from graphflow.runtime.importing import importing, refuse_to_run

TEXT = """
def main():
    refuse_to_run("graphflow.run")

main()
"""


def test_a_module_that_runs_nodes(tmp_path: Path) -> None:
    """It is refused with its line at the top, in the module itself or a function of it; only while it is imported."""
    code = compile(TEXT, str(tmp_path / "talk.py"), "exec")
    told = "talk.py:5: this calls graphflow.run when it is imported; write it below if __name__ == '__main__':"
    with importing("nodes.talk"), pytest.raises(UsageFault, match=f"{told}$"):
        exec(code, {"refuse_to_run": refuse_to_run})
    exec(code, {"refuse_to_run": refuse_to_run})
