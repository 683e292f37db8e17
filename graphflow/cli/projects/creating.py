"""`graphflow pkg create`: write a package as `ros2 pkg create` does, or a starter project of graphflow's own."""

from __future__ import annotations

import getpass
import os
import subprocess
from collections.abc import Mapping
from keyword import iskeyword
from pathlib import Path
from typing import Any

import click

from graphflow.cli import output
from graphflow.cli.projects.new_names import (
    check_dependencies,
    check_package,
    known_dependency,
    near_name,
    warn_of_name,
    warn_of_place,
)
from graphflow.cli.projects.ros_package import BUILD_TYPES, TEMPLATES, Description, known_licenses, license_text, parts
from graphflow.errors import UsageFault


class _Create(click.Command):
    """A command whose option `--dependencies` takes all words up to the next option, as in ROS 2."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        words, is_list = list[str](), False
        for word in args:
            if word.startswith("-"):
                is_list = word == "--dependencies"
                words += [] if is_list else [word]
            else:
                words += ["--dependencies", word] if is_list else [word]
        ctx.allow_extra_args = True
        left = super().parse_args(ctx, words)
        if left and not ctx.resilient_parsing:
            name = ctx.params["name"]
            if kind := next((word for word in (name, *left) if word in BUILD_TYPES), None):
                rest = [word for word in (name, *left) if word != kind]
                ctx.fail(f"{kind} is a build type: write graphflow pkg create --build-type {kind} {' '.join(rest)}")
            if all(map(known_dependency, left)):
                ctx.fail(f"write graphflow pkg create {name} --dependencies {' '.join(left)}")
            one = near_name("_".join([name, *left]))
            ctx.fail(f"a name is one word, such as {one}; list the packages that it needs after --dependencies")
        return left


@click.command(cls=_Create)
@click.argument("name", default="")
@click.option(
    "--destination-directory", type=click.Path(path_type=Path), default=Path(), help="Where to create it. [.]"
)
@click.option("--build-type", type=click.Choice(BUILD_TYPES), help="Write a ROS 2 package for this build tool.")
@click.option(
    "--template", "--template-name", type=click.Choice(list(TEMPLATES)), help="Template of its files. [by build type]"
)
@click.option("--node-name", help="Name of a first executable.")
@click.option("--library-name", help="Name of a first library.")
@click.option("--dependencies", multiple=True, metavar="PACKAGE...", help="Packages that it needs.")
@click.option("--package-format", type=click.Choice(("2", "3")), help="Format of package.xml. [3]")
@click.option("--description", help="Description for package.xml.")
@click.option("--license", help="License for package.xml; the text of a known one is written, too. ? lists those.")
@click.option("--maintainer-name", help="Maintainer for package.xml.")
@click.option("--maintainer-email", help="The maintainer's address for package.xml.")
def create(name: str, destination_directory: Path, build_type: str | None, template: str | None, **given: Any) -> None:
    """Write a package or project. With --build-type it is a ROS 2 package, or else as by `graphflow init NAME`."""
    if given["license"] == "?":
        output.lines(["Supported licenses:", *known_licenses()])
        return
    if not name:
        is_taken = given["dependencies"]
        why = ": --dependencies takes all words after it" if is_taken else ": graphflow pkg create NAME"
        raise UsageFault(f"the package's name is missing; write it first{why}")
    settings = {option: value for option, value in given.items() if value}
    if build_type or template:
        _ros_package(name, destination_directory, build_type, template, settings)
    else:
        _project(name, destination_directory, settings)


def _project(name: str, destination: Path, unused: Mapping[str, object]) -> None:
    from graphflow.cli.projects.init import check_new, write_project

    folder = destination / name
    check_new(folder)
    _print_new(name, destination)
    output.data(f"creating folder {_joined(destination, name)}")
    output.lines(f"creating {_joined(destination, file.relative_to(destination))}" for file in write_project(folder))
    options = ", ".join(f"--{option.replace('_', '-')}" for option in unused)
    said = f"{options}: not used by a graphflow project" if unused else "this is a graphflow project"
    output.talk(f"note: {said}; for a ROS 2 package, remove {name} and add --build-type ament_python")
    output.talk(f"next:\n  cd {folder}\n  graphflow up graphs/{folder.name}.yaml")


def _ros_package(
    name: str, destination: Path, build_type: str | None, template: str | None, settings: dict[str, Any]
) -> None:
    new = _complete(name, build_type, template, settings)
    folder = destination / name
    if folder.exists():
        raise UsageFault(f"{folder} already exists; choose another name or remove it")
    check_package(name, folder)
    check_dependencies(settings.get("dependencies", ()), folder)
    _print_new(name, destination)
    output.lines(new.lines())
    output.data(f"creating folder {_joined(destination, name)}")
    for path, text in parts(new):
        file = folder / path
        (file if text is None else file.parent).mkdir(parents=True, exist_ok=True)
        output.data(f"creating {'folder ' if text is None else ''}{_joined(destination, name, path)}")
        if text is not None:
            file.write_text(text, encoding="utf-8")
        if path == "package.xml":
            output.data(f"creating source {'folder' if new.build_type == 'ament_python' else 'and include folder'}")
    text = license_text(new.license)
    if text is not None:
        (folder / "LICENSE").write_text(text, encoding="utf-8")
    else:
        known = ", ".join(known_licenses())
        output.talk(f"note: no LICENSE file is written for {new.license!r}; known licenses: {known}")
    warn_of_name(name)
    warn_of_place(folder)
    output.talk(f"next:\n  {_next(new, folder)}")


def _complete(name: str, build_type: str | None, template: str | None, settings: dict[str, Any]) -> Description:
    """Complete the settings of a new package with ROS 2's defaults.

    Raises:
        UsageFault: A name cannot be a module's, or the template is for another build type.
    """
    template = template or build_type or ""
    if build_type not in (None, TEMPLATES[template]):
        raise UsageFault(f"the template {template} is for --build-type {TEMPLATES[template]}")
    node, library = settings.get("node_name"), settings.get("library_name")
    for kind, word in {"package": name, "node": node, "library": library}.items():
        if word is not None and not (word.isidentifier() and word.isascii() and not iskeyword(word)):
            rule = "use letters, digits and _, begin with a letter, and avoid Python's keywords"
            raise UsageFault(f"{word!r} cannot be the name of a {kind}: {rule}; did you mean {near_name(word)!r}?")
    if name == "test" and TEMPLATES[template] == "ament_python":
        raise UsageFault("a Python package cannot be called 'test', like the folder of its tests; choose another name")
    if node is not None and node == library:
        settings["node_name"] = f"{node}_node"
        output.talk(f"note: the library is called {library!r}, so the node is called {settings['node_name']!r}")
    settings["package_format"] = int(settings.get("package_format", 3))
    person = settings.setdefault("maintainer_name", _user())
    settings.setdefault("maintainer_email", _email() or f"{person}@todo.todo")
    return Description(name=name, template=template, **settings)


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):  # the user is unknown to the system: OSError since Python 3.13, KeyError before
        return "user"


def _email() -> str:
    """Return the user's address from git's configuration; empty if there is none."""
    try:
        words = ["git", "config", "user.email"]
        return subprocess.run(words, capture_output=True, text=True, timeout=5, check=False).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""


def _next(new: Description, folder: Path) -> str:
    """Return the command to run or the file to write next."""
    if new.build_type != "ament_python":
        return "colcon builds C++; graphflow runs the Python programs that CMakeLists.txt installs below lib/"
    if new.node_name:
        return f"graphflow run {new.name} {new.node_name}"
    return f"write a module in {folder / new.name}, and name its function in console_scripts of {folder / 'setup.py'}"


def _print_new(name: str, destination: Path) -> None:
    output.data("going to create a new package")
    output.data(f"package name: {name}")
    output.data(f"destination directory: {destination.resolve()}")


def _joined(*parts: Path | str) -> str:
    """Format a path as ROS 2 prints it: `./my_package`, `src/my_package`."""
    return os.path.join(*map(str, parts))
