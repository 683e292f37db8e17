"""Counts of what makes code hard to read and check, held against `quality.json`: CI fails when one has grown.

    python .ci/quality.py                     # print and compare
    python .ci/quality.py --update            # write the counts of today
    python .ci/quality.py --worst tui bag     # the counts of some packages, and their most complex functions

Counted in the package, stubs and generated definitions left out; `native` is all but `rclpy/`:

- `any`: uses of `Any` in annotations, per thousand lines.
- `broad excepts`: handlers of `Exception`, `BaseException` or everything; `unexplained` are those without a comment.
- `probes`: calls of `getattr` with a constant name, and of `hasattr`.
- `private`: accesses to an underscored attribute of anything but `self`, `cls`, `super()`, a class of the same file or
  a name that is annotated with one or bound to its constructor; `DOCUMENTED` names do not count.
- `complex`: functions of a cyclomatic complexity above 10; none may be above 15.
- `ignores`: comments that turn off the type checker.
- `lines`: lines of code, in thousands.
"""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

PROJECT = Path(__file__).parents[1]
PACKAGE = PROJECT / "graphflow"
BASELINE = Path(__file__).with_name("quality.json")
BROAD = ("Exception", "BaseException")
DOCUMENTED = {"_getframe", "_current_frames", "_exit", "_replace", "_asdict", "_make", "_fields"}
"""Underscored names that the standard library documents for all to use, of `sys`, `os` and named tuples."""
ON_TOP = 15
"""The highest cyclomatic complexity of a function."""


def sources(packages: list[str]) -> dict[Path, str]:
    """The files of some packages by their names, or of all."""
    files = sorted(PACKAGE.rglob("*.py"))
    return {p: p.read_text("utf-8") for p in files if not packages or p.relative_to(PACKAGE).parts[0] in packages}


def counts_of(text: str) -> Counter[str]:
    """The counts of one file, but for complexity."""
    found: Counter[str] = Counter()
    tree = ast.parse(text)
    lines = text.splitlines()
    own = _own_names(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and node.id == "Any":
            found["any"] += 1
        elif isinstance(node, ast.ExceptHandler) and _is_broad(node):
            found["broad excepts"] += 1
            around = lines[node.lineno - 1 : node.body[0].lineno]
            found["unexplained"] += not any("#" in line for line in around)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            found["probes"] += node.func.id == "hasattr" or (node.func.id == "getattr" and _is_text(node.args[1:2]))
        elif isinstance(node, ast.Attribute) and re.match(r"_[a-z]", node.attr):
            found["private"] += node.attr not in DOCUMENTED and not _is_own(node.value, own)
    found["ignores"] = text.count("# type: ignore")
    found["lines"] = len(lines)
    return found


def _own_names(tree: ast.Module) -> set[str]:
    """The names by which a file refers to its own classes and their instances."""
    classes = {node.name for node in ast.walk(tree) if isinstance(node, ast.ClassDef)}
    found = {"self", "cls", *classes}
    for node in ast.walk(tree):
        if isinstance(node, ast.arg) and node.annotation is not None and _is_of(node.annotation, classes):
            found.add(node.arg)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and _is_of(node.annotation, classes):
            found.add(node.target.id)
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and _is_of(node.value.func, classes):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return found


def _is_of(annotation: ast.expr, classes: set[str]) -> bool:
    """Whether an annotation is one of some classes, or that and `None`."""
    names = {name.strip() for name in ast.unparse(annotation).strip("'").split("|")} - {"None"}
    return bool(names) and names <= {"cls", *classes}


def _is_own(value: ast.expr, own: set[str]) -> bool:
    if isinstance(value, ast.Call):
        return isinstance(value.func, ast.Name) and value.func.id == "super"
    return isinstance(value, ast.Name) and value.id in own


def _is_broad(handler: ast.ExceptHandler) -> bool:
    caught = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    return any(c is None or (isinstance(c, ast.Name) and c.id in BROAD) for c in caught)


def _is_text(args: list[ast.expr]) -> bool:
    return bool(args) and isinstance(args[0], ast.Constant)


def complexities(packages: list[str]) -> list[tuple[int, str]]:
    """The functions of a complexity above 10, with their places, the most complex first."""
    folders = [str(PACKAGE / name) for name in packages] or [str(PACKAGE)]
    command = [sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache", "--select", "C901"]
    command += ["--config", "lint.mccabe.max-complexity=10", "--output-format", "concise", *folders]
    printed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    rows = re.findall(r"^(\S+:\d+):\d+: C901 `(\w+)` is too complex \((\d+) > 10\)", printed, re.MULTILINE)
    return sorted(((int(n), f"{place} {name}") for place, name, n in rows), reverse=True)


def measure(packages: list[str], above: list[tuple[int, str]]) -> dict[str, float]:
    """All counts, by their names in the table."""
    kinds = {"native": Counter[str](), "rclpy": Counter[str]()}
    for path, text in sources(packages).items():
        kinds["rclpy" if "rclpy" in path.relative_to(PACKAGE).parts[:1] else "native"] += counts_of(text)
    found: dict[str, float] = {}
    for kind, counts in kinds.items():
        found[f"{kind}: Any per 1,000 lines"] = round(1000 * counts["any"] / max(counts["lines"], 1), 1)
        for name in ("broad excepts", "unexplained", "probes", "private", "ignores"):
            found[f"{kind}: {name}"] = counts[name]
    found["complex functions, above 10"] = len(above)
    found[f"complex functions, above {ON_TOP}"] = sum(n > ON_TOP for n, _ in above)
    found["lines of the package"] = sum(c["lines"] for c in kinds.values())
    return found


def main() -> int:
    packages = [word for word in sys.argv[1:] if not word.startswith("-")]
    above = complexities(packages)
    found = measure(packages, above)
    for n, place in above if "--worst" in sys.argv else ():
        print(f"{n:4} {place}")
    if packages:
        print("\n".join(f"{name:40} {n:>9,g}" for name, n in found.items()))
        return 0
    if "--update" in sys.argv:
        BASELINE.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    held = json.loads(BASELINE.read_text("utf-8"))
    grown = [name for name, n in found.items() if n > held.get(name, 0) and not name.startswith("lines")]
    for name, n in found.items():
        print(f"{name:40} {n:>9,g}   held: {held.get(name, 0):,g}{'   GROWN' if name in grown else ''}")
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main())
