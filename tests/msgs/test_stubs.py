"""The checked-in stubs say what the definitions say."""

import ast
import inspect
from pathlib import Path

import pytest

from graphflow.msgs import registry, stubs
from graphflow.wire.cdr.unchecked import LENT


def test_checked_in_stubs_are_current() -> None:
    """The stubs in the tree are exactly those the generator makes; if not, run `python -m graphflow.msgs.stubs`."""
    written = {file: file.read_text(encoding="utf-8") for file in registry.BUNDLED.rglob("*.pyi")}
    assert written == stubs.bundled_stubs()


@pytest.mark.parametrize("package", registry.packages())
def test_stub_agrees_with_the_class(package: str) -> None:
    """Every class of a stub exists at run time, with the same attributes and constructor parameters."""
    for kind in registry.KINDS:
        for node in ast.parse(stubs.stub(package, kind)).body:
            if not isinstance(node, ast.ClassDef):
                continue
            cls = registry.interface_class(f"{package}/{kind}/{node.name}")
            attributes = [
                n.target.id for n in node.body if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)
            ]
            assert all(hasattr(cls, name) for name in attributes)
            methods = {n.name: n for n in node.body if isinstance(n, ast.FunctionDef)}
            assert all(hasattr(cls, name) for name in methods)
            for init in [methods["__init__"]] if "__init__" in methods else []:
                taken = [name for name in inspect.signature(cls).parameters if name != LENT]
                assert [p.arg for p in init.args.kwonlyargs] == taken


def test_alias_package_has_stubs() -> None:
    """turtlesim_msgs, which has no definitions of its own, is stubbed like turtlesim."""
    assert stubs.stub("turtlesim_msgs", "msg") == stubs.stub("turtlesim", "msg")


def test_nested_type_of_another_package_keeps_its_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two classes of one name, one of them from another package, stay apart in a stub."""
    folder = tmp_path / "interfaces" / "stub_test_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Pose.msg").write_text("geometry_msgs/Pose pose\nfloat64 grip\n")
    (folder / "Poses.msg").write_text("string FRAME='map'\nPose[<=2] poses\nbyte[] raw\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    text = stubs.stub("stub_test_msgs", "msg")
    assert "from graphflow.msgs.geometry_msgs import msg as geometry_msgs\n" in text
    assert "    pose: geometry_msgs.Pose\n" in text
    assert '    FRAME: ClassVar[Literal["map"]]\n    poses: list[Pose]\n    raw: npt.NDArray[np.uint8]\n' in text
    assert "poses: Sequence[Pose | Mapping[str, object]] = ...," in text
