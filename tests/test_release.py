"""What a release takes fits together: the version, the change log, the page on an index, the archives."""

from __future__ import annotations

import re
import tomllib
from datetime import date

import graphflow
from tests.conftest import PROJECT

PYPROJECT = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))
CHANGELOG = (PROJECT / "CHANGELOG.md").read_text(encoding="utf-8")
SECTIONS = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]
"""Source: Keep a Changelog 1.1."""


def test_the_change_log_has_this_version() -> None:
    """What is unreleased is a development version of the release that it will be; a release has its date."""
    released = re.match(r"\d+\.\d+\.\d+", graphflow.__version__)
    assert released is not None
    headings = re.findall(r"^## \[(.+?)\](?: - (\S+))?$", CHANGELOG, re.MULTILINE)
    version, day = headings[0]
    if graphflow.__version__ == f"{released[0]}.dev0":
        assert (version, day) == ("Unreleased", "")
        assert released[0] not in dict(headings)
    else:
        assert (graphflow.__version__, version) == (released[0], released[0])
        assert date.fromisoformat(day)


def test_each_section_of_the_change_log_stands_once() -> None:
    """In the order of Keep a Changelog, for each version."""
    for version in CHANGELOG.split("\n## ")[1:]:
        found = re.findall(r"^### (.+)$", version, re.MULTILINE)
        assert found == [name for name in SECTIONS if name in found]


def on_an_index(text: str) -> str:
    """The README as the package's metadata has it."""
    for rule in PYPROJECT["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]["substitutions"]:
        text = re.sub(rule["pattern"], rule["replacement"], text)
    return text


def test_an_index_shows_no_link_or_picture_that_leads_nowhere() -> None:
    """The files around the README are not there; its words stay."""
    readme = (PROJECT / "README.md").read_text(encoding="utf-8")
    shown = on_an_index(readme)
    assert re.findall(r"\]\((?!https?://)[^)]*\)|<img[^>]*>", shown) == []
    assert (
        on_an_index("[a\nb](docs/c.md#d) [e](https://f.org)\n\n<img src='g.svg'>\n\nh")
        == "a\nb [e](https://f.org)\n\nh"
    )
    assert "https://docs.astral.sh/uv/" in shown
    assert len(shown) > 0.8 * len(readme)


def test_archives_have_what_their_files_refer_to() -> None:
    """The source archive has all that the README and the tests read, and nothing is included that is not there."""
    patterns = PYPROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    included = [pattern.removeprefix("/") for pattern in patterns]
    assert [name for name in included if not list(PROJECT.glob(name))] == []
    linked = re.findall(r"\]\((?!https?://)([^)#]*)", (PROJECT / "README.md").read_text(encoding="utf-8"))
    covered = {str(path.relative_to(PROJECT)) for name in included for path in PROJECT.glob(name)}
    assert [link for link in linked if link not in covered and link.split("/")[0] not in covered] == []
