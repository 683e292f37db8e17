"""`graphflow launch FILE` and `launch convert`: run ROS launch files, or convert them to graph files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.cli.arguments import GraphCommand
from graphflow.cli.verbs import Verbs
from graphflow.errors import Place, Problem, UsageFault
from graphflow.names import did_you_mean, nearest
from graphflow.workspace.packages import FOLDERS_BOUND

if TYPE_CHECKING:
    from graphflow.markup.tree import Item


class _Verbs(Verbs):
    """The verbs of `launch`; `launch FILE` and `launch PACKAGE FILE` mean the hidden verb `start`."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        is_verb = not args or args[0] in (*self.list_commands(ctx), "--help", "-h")
        return super().parse_args(ctx, args if is_verb else ["start", *args])


@click.group(cls=_Verbs, subcommand_metavar="[PACKAGE] FILE [NAME:=VALUE]... | convert FILE")
def launch() -> None:
    """Start a launch file as `up` does, or convert it.

    \b
    Options before FILE:
      -s, --show-args                      show the file's arguments without starting it
      -p, --print                          show what would run without starting it
      -n, --noninteractive, --no-console   show logs instead of the console
      --detach                             leave it running in the background
      --json                               print events as lines of JSON, without the console
    """  # noqa: D301 - click wants the character


@launch.command(cls=GraphCommand, hidden=True)
@click.argument("words", nargs=-1, required=True, metavar="[PACKAGE] FILE [NAME:=VALUE]...")
@click.option("-s", "--show-args", is_flag=True, help="Show the file's arguments without starting it.")
@click.option("-p", "--print", "is_shown", is_flag=True, help="Show what would run without starting it.")
@click.option("-n", "--noninteractive", "--no-console", is_flag=True, help="Show logs instead of the console.")
@click.option("--detach", is_flag=True, help="Leave it running in the background, as `up -d` does.")
@click.option("--json", is_flag=True, help="Print events as lines of JSON, as `up --json` does.")
@click.option("-d", "--debug", is_flag=True, help="Accepted for ROS 2; it has no effect.")
@click.option("-a", "--show-all-subprocesses-output", is_flag=True, help="Accepted for ROS 2; it is always shown.")
def start(words: tuple[str, ...], **options: bool) -> int:
    """Start a launch file, of a package if one is named."""
    from graphflow.cli.graphs.files import plan
    from graphflow.cli.graphs.graphs import up

    file, given = _file_of(words)
    is_shown = options["is_shown"]
    if options["debug"]:
        output.talk("note: -d is ROS's --debug, which has no effect here; --detach leaves the graph in the background")
    shared = {"--json": options["json"]}
    flags = (
        shared
        if is_shown
        else shared
        | {
            "--show-args": options["show_args"],
            "--no-console": options["noninteractive"],
            "--detach": options["detach"],
        }
    )
    verb, top = plan if is_shown else up, click.get_current_context().find_root()
    # Run as `up` or `plan` below the top command, so that errors show that verb's usage.
    code = verb.main(
        [*(flag for flag, is_on in flags.items() if is_on), file, *given],
        prog_name=verb.name,
        standalone_mode=False,
        parent=top,
    )
    return code if isinstance(code, int) else exits.OK


def _file_of(words: tuple[str, ...]) -> tuple[str, list[str]]:
    """Return the launch file that is meant, and its arguments.

    Raises:
        UsageFault: The package does not exist or has no such file.
    """
    from graphflow.workspace.executables import package_share
    from graphflow.workspace.manifest import fault_of
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.project import project_root
    from graphflow.workspace.unfound import uninstalled_files

    first, *rest = words
    if not rest or ":=" in rest[0] or Path(first).is_file():
        _refuse_package(first)
        return first, rest
    folder = package_share(first, project_root(Path.cwd()), os.environ)
    if folder is None:
        raise UsageFault(_no_package(first, rest))
    files = sorted(_files_below(folder))
    found = [file for file in files if file.match(rest[0]) and file.suffix in _ENDINGS]
    own = find_workspace(Path.cwd()).packages.get(first)
    if not found:
        raise UsageFault(_no_launch_file(first, rest[0], _launch_files(files)))
    if own is not None:
        for fault in filter(None, (fault_of(own.folder / "package.xml"), uninstalled_files(own))):
            output.talk(f"note: {fault}")
    return str(found[0]), rest[1:]


def _no_package(first: str, rest: list[str]) -> str:
    """Return the error text for a package that there is not."""
    from graphflow.cli.substitutes import no_package
    from graphflow.workspace.executables import SLIP, of_ros, package_share
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.project import demos_root, project_root
    from graphflow.workspace.unfound import why_no_package

    if first.endswith(_ENDINGS) and package_share(rest[0], project_root(Path.cwd()), os.environ) is not None:
        return f"the package comes first: graphflow launch {' '.join([rest[0], first, *rest[1:]])}"
    if substitute := no_package(first):
        return substitute
    why = why_no_package(first, find_workspace(Path.cwd()))
    if why is None and first in of_ros():
        graph = (demos_root() / "graphs" / f"{first}.yaml").is_file()
        way = f"; to start its graph: graphflow up {first}" if graph else "; graphflow launch FILE starts a file"
        return f"the package {first!r} that comes with graphflow has no launch files{way}"
    near = nearest(first, [*find_workspace(Path.cwd()).packages, *of_ros()], cutoff=SLIP)
    way = f"; did you mean {near!r}?" if near is not None else _ELSEWHERE
    return f"Package {first!r} not found{f': {why}' if why else way}"


def _no_launch_file(package: str, name: str, known: list[str]) -> str:
    """Return the error text for a file that a package does not have.

    Args:
        known: The launch files that it has.
    """
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.unfound import why_no_package

    workspace = find_workspace(Path.cwd())
    own = workspace.packages.get(package)
    if own is None and (why := why_no_package(package, workspace)) is not None:
        return f"Package {package!r} not found: {why}"
    if own is not None and own.known_as(name) is not None:
        return f"{package} has no file {name!r}; that is an executable: graphflow run {package} {name}"
    begun = [file for file in known if file.startswith(f"{name}.")]
    return f"{package} has no file {name!r}{f'; did you mean {begun[0]!r}?' if begun else did_you_mean(name, known)}"


_ELSEWHERE = "; go to the folder that has it in src/, or to one within it, or start a file: graphflow launch FILE"
_ENDINGS = (".py", ".xml", ".yaml", ".yml", ".launch")
"""Suffixes of launch files."""


def _refuse_package(word: str) -> None:
    """Check that a single word is not the name of a package with launch files.

    Raises:
        UsageFault: It is; the text lists its launch files.
    """
    if Path(word).exists() or not word.isidentifier():
        return
    files = launch_files(word)
    if files:  # a package without launch files may share its name with a graph, which is meant then
        raise UsageFault(f"{word!r} is a package; write graphflow launch {word} FILE; it has {', '.join(files)}")


def launch_files(package: str) -> list[str]:
    """Return the names of a package's launch files."""
    from graphflow.workspace.executables import package_share
    from graphflow.workspace.project import project_root

    folder = package_share(package, project_root(Path.cwd()), os.environ)
    return [] if folder is None else _launch_files(_files_below(folder))


def _launch_files(files: Iterable[Path]) -> list[str]:
    """Return the names that contain `launch`."""
    return sorted({file.name for file in files if "launch" in file.name})


def _files_below(folder: Path) -> Iterator[Path]:
    """Yield the files below a folder, following links to folders; each folder once, and a bounded number."""
    seen: set[str] = set()
    for at, folders, names in os.walk(folder, followlinks=True):
        folders[:] = [one for one in folders if os.path.realpath(os.path.join(at, one)) not in seen]
        seen.update(os.path.realpath(os.path.join(at, one)) for one in folders)
        if len(seen) > FOLDERS_BOUND:
            return
        yield from (Path(at, name) for name in names)


@launch.command()
@click.argument("file", metavar="FILE", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option(
    "-o", "--output", "target", metavar="GRAPH.yaml", type=click.Path(path_type=Path), help="Write to a file."
)
def convert(file: Path, target: Path | None) -> int:
    """Convert a launch file in Python, XML or YAML to a graph file.

    What a graph file cannot express is listed with its line. A Python launch file is executed, in a process of its own,
    with replacements of ROS's launch packages: do not convert files that you do not trust.

    Exit code 0: everything was converted; 1: something was not.
    """
    from graphflow.launchfiles.conversion import FROM_LAUNCH
    from graphflow.launchfiles.reading import read
    from graphflow.supervisor.launching.launch_python import described
    from graphflow.workspace.project import shown

    problems: list[Problem] = []

    def complain(place: Place, message: str) -> None:
        problems.append(Problem(place, message))

    if target is not None and target.exists():
        raise UsageFault(f"{target} already exists; remove it, or name another file")
    top = read(file, shown(file), complain, complain, described, remark=complain, leave_out=complain)
    text = f"# From {file.name}, by graphflow launch convert.\n{_yaml(top.without(FROM_LAUNCH))}"
    if target is None:
        output.lines(text.rstrip("\n").split("\n"))
    else:
        target.write_text(text, encoding="utf-8")
        output.talk(f"{target}: written; try it with: graphflow check {target}")
    for problem in sorted(set(problems)):
        output.talk(str(problem))
    return exits.FAILED if problems else exits.OK


def _yaml(top: Item) -> str:
    """Format a tree as YAML that parses to the same tree."""
    import yaml

    from graphflow.markup.source import scalar
    from graphflow.markup.substitutions import Written

    class Dumper(yaml.SafeDumper):
        """A dumper that quotes every text that YAML 1.2 would read as another type."""

        def ignore_aliases(self, data: object) -> bool:
            return True

    def text(dumper: yaml.SafeDumper, value: str) -> yaml.ScalarNode:
        try:
            is_text = isinstance(scalar(value), str)
        except ValueError:
            is_text = False
        return dumper.represent_scalar("tag:yaml.org,2002:str", value, style=None if is_text else "'")

    Dumper.add_representer(str, text)
    Dumper.add_representer(Written, lambda dumper, value: dumper.represent_data(value.value))
    return yaml.dump(
        top.plain(), Dumper=Dumper, sort_keys=False, default_flow_style=None, width=110, allow_unicode=True
    )
