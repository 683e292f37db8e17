"""Makes the pictures of the console in `docs/pictures/`, from graphs that run while it watches.

    python docs/make_pictures.py             # all of them; takes two minutes
    python docs/make_pictures.py deadlock    # one scene

Each scene drives the real program in a real terminal, tmux, and takes what is on its screen as SVG and as PNG.
`deadlock` is also recorded: as an animated SVG, and as an asciicast, which `asciinema play` shows. Needs tmux and
rsvg-convert.
"""

from __future__ import annotations

import html
import json
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from rich.ansi import AnsiDecoder
from rich.color import Color
from rich.console import Console
from rich.terminal_theme import SVG_EXPORT_THEME
from rich.text import Text

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.conftest import Machine
from tests.tui.terminal import Terminal

PICTURES = Path(__file__).parent / "pictures"
WIDE, SMALL = (110, 32), (80, 24)
GALLERY, BROAD, TALL = (128, 17), (172, 17), (100, 52)
SIZES = {"ten_turtles": TALL, "turtle_tf2": BROAD}
CELL_WIDTH, CELL_HEIGHT, FONT_SIZE, MARGIN = 8.43, 17.0, 14, 10
GROUND, INK = "#0f151c", "#d9e2ec"
FONTS = "DejaVu Sans Mono, Menlo, Consolas, monospace"
PNG_WIDTH = 1200
GAP = 4
"""Columns between two frames of a film."""
PIECES = re.compile("[\u2800-\u28ff]+|(?! )[^\u2800-\u28ff]*[^ \u2800-\u28ff]")
"""Braille patterns, or text without the spaces around it."""
DOTS = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))
"""Column and line of each bit of a Braille pattern (Unicode, chapter 21.1)."""
FRAME = 0.25
"""Seconds between two looks at the screen while it is recorded."""

CONSOLE = Console(color_system="truecolor", width=1000)


class Stage:
    """A machine of its own, and the terminals on it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.machine = Machine(folder)
        self.machine.env |= {"COLORTERM": "truecolor", "GRAPHFLOW_THEME": "graphflow-dark"}
        state = Path(self.machine.env["XDG_STATE_HOME"]) / "graphflow"
        state.mkdir(parents=True)
        (state / ".welcomed").touch()
        self._terminals: list[Terminal] = []

    def open(self, words: str, size: tuple[int, int] = WIDE) -> Terminal:
        """Type `graphflow WORDS` in a new terminal."""
        socket = self._folder / f"t{len(self._terminals)}"
        self._terminals.append(Terminal(self.machine, socket, f"{sys.executable} -m graphflow {words}", size))
        return self._terminals[-1]

    def close(self) -> None:
        self.machine.run("down", "--all", code=None)
        for terminal in self._terminals:
            terminal.hang_up()


@contextmanager
def stage() -> Iterator[Stage]:
    with tempfile.TemporaryDirectory(prefix="gf") as folder:
        made = Stage(Path(folder))
        try:
            yield made
        finally:
            made.close()


# scenes


def turtlesim() -> None:
    """The first screen, the turtles alone, the graph, parameters, and a small terminal."""
    with stage() as s:
        t = s.open("up graphs/turtlesim.yaml")
        t.until("● running")
        time.sleep(24)
        take(t, "home")
        small = s.open("attach", SMALL)
        small.until("● running")
        time.sleep(4)
        take(small, "small")
        t.press("C-b", "z")
        time.sleep(22)
        take(t, "turtle")
        t.press("C-b", "z")
        open_window(t, "graph")
        t.until("/turtle1/pose")
        time.sleep(3)
        take(t, "graph")
        open_window(t, "params /turtlesim")
        t.until("background_r")
        t.press("Down", "Down", "Enter")
        time.sleep(1)
        take(t, "params")


def goals() -> None:
    """Goals under way and done."""
    with stage() as s:
        t = s.open("up graphs/fibonacci.yaml order:=12")
        t.until("● running")
        open_window(t, "goals")
        time.sleep(6)
        take(t, "goals")


def deadlock() -> None:
    """A deadlock that is seen, ended by a key, and gone; recorded."""
    with stage() as s:
        t = s.open("up graphs/deadlock/crossing_broken.yaml", (100, 30))
        t.until("● running")
        film = Film(t)
        film.run_until("DEADLOCK found", 30)
        film.run(2.5)
        t.press("C-b")
        film.run(1.2)
        t.press("g")
        film.run_until("f  give", 10)
        film.run(5)
        take(t, "deadlock")
        t.press("f")
        film.run_until("It moves again", 10)
        film.run(3)
        take(t, "deadlock-ended")
        t.press("w")
        film.run_until("Write the groups", 10)
        film.run(4)
        t.press("Escape")
        film.run(0.5)
        t.press("C-b", "0")
        film.run(4)
        film.save("deadlock")


def mapping() -> None:
    """A robot that maps a house."""
    with stage() as s:
        t = s.open("up graphs/tb_map.yaml rate:=2.0", (110, 34))
        t.until("● running", 60)
        time.sleep(32)
        t.press("Tab")
        open_window(t, "map")
        time.sleep(3)
        t.press("minus", "minus", "minus")
        time.sleep(3)
        take(t, "mapping")


def gallery() -> None:
    """Each graph that comes with graphflow, as the view `graph` draws it; for `docs/gallery.md`."""
    for file in sorted(Path("graphs").glob("*.yaml")):
        if file.stem == "fibonacci":  # it has no topics; the scene `goals` shows it
            continue
        with stage() as s:
            t = s.open(f"up {file}", SIZES.get(file.stem, GALLERY))
            t.until("● running", 60)
            time.sleep(4)
            open_window(t, "graph")
            time.sleep(3)
            take(t, f"graph-{file.stem}")


SCENES: dict[str, Callable[[], None]] = {
    "turtlesim": turtlesim,
    "goals": goals,
    "deadlock": deadlock,
    "mapping": mapping,
    "gallery": gallery,
}


def open_window(t: Terminal, content: str) -> None:
    """Show something by the command line, and move it to a window of its own, unless it needs one and has it."""
    t.press("C-b", ":")
    t.until("Any verb of graphflow")
    t.type(content)
    t.press("Enter")
    time.sleep(0.5)
    if f":{content.split()[0]}*" not in t.text:
        t.press("C-b", "!")
        time.sleep(0.5)


# pictures


def take(t: Terminal, name: str) -> None:
    """Save what is on the screen."""
    width, height, lines = look(t)
    body = "".join(f'<g transform="translate(0 {y * CELL_HEIGHT:.0f})">{row(line)}</g>' for y, line in enumerate(lines))
    file = PICTURES / f"{name}.svg"
    file.write_text(svg(width, height, body), encoding="utf-8")
    png = ["rsvg-convert", "--width", str(PNG_WIDTH), "--output", str(file.with_suffix(".png")), str(file)]
    subprocess.run(png, check=True, timeout=60)
    print(file)


def look(t: Terminal) -> tuple[int, int, list[Text]]:
    """The screen's columns, rows and text with its styles."""
    width, height = t.size
    lines = list(AnsiDecoder().decode(t.styled_text))[:height]
    return width, height, lines + [Text()] * (height - len(lines))


def svg(width: int, height: int, body: str, style: str = "") -> str:
    """A terminal of so many columns and rows."""
    w, h = width * CELL_WIDTH + 2 * MARGIN, height * CELL_HEIGHT + 2 * MARGIN
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w:.0f} {h:.0f}" font-family="{FONTS}" '
        f'font-size="{FONT_SIZE}" xml:space="preserve"><style>text{{white-space:pre}}{style}</style>'
        f'<rect width="100%" height="100%" rx="8" fill="{GROUND}"/>'
        f'<svg x="{MARGIN}" y="{MARGIN}" width="{width * CELL_WIDTH:.0f}" height="{height * CELL_HEIGHT:.0f}">'
        f"{body}</svg></svg>\n"
    )


def row(line: Text) -> str:
    """One line: grounds first, then the text, piece by piece."""
    grounds, texts, at = [], [], 0
    for segment in line.render(CONSOLE):
        style, length = segment.style, len(segment.text)
        if style is None or not length or segment.text == "\n":
            continue
        ink, ground = hexed(style.color, INK), hexed(style.bgcolor, GROUND)
        ink, ground = (ground, ink) if style.reverse else (ink, ground)
        x, w = at * CELL_WIDTH, length * CELL_WIDTH
        if ground != GROUND:
            grounds.append(
                f'<rect x="{x:.1f}" width="{w + 0.4:.1f}" height="{CELL_HEIGHT + 0.4:.1f}" fill="{ground}"/>'
            )
        weight = ' font-weight="bold"' if style.bold else ""
        for piece in PIECES.finditer(segment.text):
            text, x = piece[0], (at + piece.start()) * CELL_WIDTH
            texts.append(
                dots(text, x, ink)
                if is_dots(text)
                else f'<text x="{x:.1f}" y="{CELL_HEIGHT - 4:.0f}" textLength="{len(text) * CELL_WIDTH:.1f}" '
                f'fill="{ink}"{weight}>{html.escape(text)}</text>'
            )
        at += length
    return "".join([*grounds, *texts])


def is_dots(text: str) -> bool:
    return "\u2800" <= text[0] <= "\u28ff"


def dots(text: str, x: float, ink: str) -> str:
    """Braille patterns as dots: few monospaced fonts have them, and those of other fonts are too wide."""
    found = []
    for i, letter in enumerate(text):
        for bit, (column, line) in enumerate(DOTS):
            if ord(letter) & 1 << bit:
                cx, cy = x + (i + 0.25 + 0.5 * column) * CELL_WIDTH, (line + 0.5) * CELL_HEIGHT / 4
                found.append(f"M{cx:.1f} {cy:.1f}h0")
    return f'<path d="{"".join(found)}" stroke="{ink}" stroke-width="2" stroke-linecap="round"/>' if found else ""


def hexed(colour: Color | None, usual: str) -> str:
    return usual if colour is None or colour.is_default else colour.get_truecolor(SVG_EXPORT_THEME).hex


# films


class Film:
    """What a terminal shows, with times."""

    def __init__(self, terminal: Terminal) -> None:
        self._terminal = terminal
        self._began = time.monotonic()
        self._frames: list[tuple[float, list[Text], str]] = []

    def run(self, seconds: float) -> None:
        """Record for so long."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._look()

    def run_until(self, what: str, limit: float) -> None:
        """Record until a text is on the screen."""
        end = time.monotonic() + limit
        while what not in self._look():
            assert time.monotonic() < end, f"no {what!r} on:\n{self._terminal.text}"

    def _look(self) -> str:
        at = time.monotonic() - self._began
        raw = self._terminal.styled_text
        if not self._frames or raw != self._frames[-1][2]:
            self._frames.append((at, look(self._terminal)[2], raw))
        time.sleep(FRAME)
        return "\n".join(line.plain for line in self._frames[-1][1])

    def save(self, name: str) -> None:
        """Save an animated SVG, in which each line is stored once, and an asciicast."""
        width, height = self._terminal.size
        (PICTURES / f"{name}.cast").write_text(cast(width, height, self._frames), encoding="utf-8")
        first, total = self._frames[0][0], time.monotonic() - self._began
        rows: dict[str, int] = {}
        strip, stops = [], []
        for i, (at, lines, _) in enumerate(self._frames):
            left = i * (width + GAP) * CELL_WIDTH
            stops.append(f"{100 * (at - first) / (total - first):.2f}%{{transform:translateX({-left:.0f}px)}}")
            for y, line in enumerate(lines):
                drawn = row(line)
                if drawn:
                    number = rows.setdefault(drawn, len(rows))
                    strip.append(f'<use href="#r{number}" x="{left:.0f}" y="{y * CELL_HEIGHT:.0f}"/>')
        defs = "".join(f'<g id="r{number}">{drawn}</g>' for drawn, number in rows.items())
        style = f"@keyframes play{{{''.join(stops)}}}.film{{animation:play {total - first:.1f}s steps(1,end) infinite}}"
        body = f'<defs>{defs}</defs><g class="film">{"".join(strip)}</g>'
        file = PICTURES / f"{name}-film.svg"
        file.write_text(svg(width, height, body, style), encoding="utf-8")
        print(file, f"{len(self._frames)} frames, {total - first:.0f} s")


def cast(width: int, height: int, frames: Sequence[tuple[float, list[Text], str]]) -> str:
    """Frames as asciicast, version 2."""
    head = json.dumps({"version": 2, "width": width, "height": height, "title": "graphflow: a deadlock ended by a key"})
    events = (
        json.dumps([round(at - frames[0][0], 2), "o", "\x1b[H\x1b[0m" + raw.rstrip("\n").replace("\n", "\r\n")])
        for at, _, raw in frames
    )
    return "\n".join([head, *events]) + "\n"


def main() -> None:
    """Make the scenes that are named, or all."""
    PICTURES.mkdir(exist_ok=True)
    for name in sys.argv[1:] or SCENES:
        SCENES[name]()


if __name__ == "__main__":
    main()
