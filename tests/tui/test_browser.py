"""The console in a real browser, without a window: a page that draws, keys that arrive, a tab that is closed."""

from __future__ import annotations

import asyncio
import base64
import json
import shutil
import subprocess
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from graphflow.transport.rendezvous import free_endpoint
from tests.cases import slow
from tests.conftest import LIMIT, Machine

aiohttp = pytest.importorskip("aiohttp", reason="the extra `web` is not installed")
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(CHROMIUM is None, reason="needs chromium; on Debian: apt install chromium"),
]


class Tab:
    """A tab of the browser, as its debugger sees it."""

    def __init__(self, socket: Any) -> None:
        self._socket = socket
        self._number = 0
        self.drawn = ""
        """All that the console has sent to the page."""

    async def do(self, method: str, **parameters: Any) -> None:
        """Have the browser do something."""
        self._number += 1
        await self._socket.send_json({"id": self._number, "method": method, "params": parameters})

    async def click(self, x: int, y: int) -> None:
        for kind in ("mousePressed", "mouseReleased"):
            await self.do("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    async def type(self, character: str) -> None:
        code = ord(character.upper())
        await self.do(
            "Input.dispatchKeyEvent", type="keyDown", key=character, text=character, windowsVirtualKeyCode=code
        )
        await self.do("Input.dispatchKeyEvent", type="keyUp", key=character, windowsVirtualKeyCode=code)

    async def until(self, what: str) -> None:
        """Read what the page receives until a text is in it."""
        async with asyncio.timeout(LIMIT):
            while what not in self.drawn:
                event = await self._socket.receive_json()
                if event.get("method") == "Network.webSocketFrameReceived":
                    frame = event["params"]["response"]
                    data = base64.b64decode(frame["payloadData"]) if frame["opcode"] == 2 else b""
                    self.drawn += data.decode(errors="replace")


def start(folder: Path) -> subprocess.Popen[bytes]:
    assert CHROMIUM is not None
    options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0", "--no-first-run"]
    words = [CHROMIUM, *options, f"--user-data-dir={folder}", "about:blank"]
    return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@asynccontextmanager
async def browser(folder: Path) -> AsyncIterator[Any]:
    """A browser of its own; what it yields opens tabs."""
    process = start(folder)
    try:
        async with asyncio.timeout(LIMIT), aiohttp.ClientSession() as session:
            while not (folder / "DevToolsActivePort").exists():
                await asyncio.sleep(0.05)
            port = (folder / "DevToolsActivePort").read_text().split()[0]

            @asynccontextmanager
            async def tab(url: str) -> AsyncIterator[Tab]:
                async with session.put(f"http://127.0.0.1:{port}/json/new") as answer:
                    found = await answer.json()
                async with session.ws_connect(found["webSocketDebuggerUrl"], max_msg_size=0) as socket:
                    made = Tab(socket)
                    await made.do("Network.enable")
                    await made.do("Page.navigate", url=url)
                    yield made
                async with session.get(f"http://127.0.0.1:{port}/json/close/{found['id']}"):
                    pass

            yield tab
    finally:
        process.terminate()
        process.wait(LIMIT)


async def consoles(machine: Machine, count: int) -> None:
    async with asyncio.timeout(LIMIT):
        while len(json.loads(await asyncio.to_thread(machine.run, "ls", "--json"))[0]["consoles"]) != count:
            await asyncio.sleep(0.1)


@slow
def test_a_console_in_a_tab(machine: Machine, tmp_path: Path) -> None:
    """It shows the graph, takes keys, and is gone with its tab; the graph runs on. A stranger's page gets nothing."""
    machine.run("up", "-d", "graphs/talker_listener.yaml")
    port = free_endpoint().rpartition(":")[2]
    url = f"http://127.0.0.1:{port}/"
    server = machine.start("console", "--web", "--port", port)
    server.wait_for("Serving")

    async def look() -> None:
        async with browser(tmp_path / "browser") as open_tab, open_tab(url) as tab:
            await tab.until("/talker")
            await tab.until("running")
            await consoles(machine, 1)
            await tab.click(100, 100)  # the page takes keys once it has the focus
            await tab.type(":")
            await tab.until("Any verb of graphflow")
            async with aiohttp.ClientSession() as session:
                for headers in ({"Origin": "http://example.org"}, {"Host": f"example.org:{port}"}):
                    async with session.get(f"{url}ws", headers=headers) as answer:
                        assert answer.status == 403
        await consoles(machine, 0)

    asyncio.run(look())
    assert server.end() == 0
    assert "/talker" in machine.look("ps")
