"""A real browser without a window, driven by its debugger."""

from __future__ import annotations

import asyncio
import base64
import shutil
import subprocess
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import LIMIT
from tests.until import eventually

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
NEEDS_BROWSER = pytest.mark.skipif(CHROMIUM is None, reason="needs chromium; on Debian: apt install chromium")


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

    async def press(self, key: str, code: int) -> None:
        """Hold a key down that types nothing."""
        await self.do("Input.dispatchKeyEvent", type="keyDown", key=key, windowsVirtualKeyCode=code)

    async def evaluate(self, script: str) -> Any:
        """What a script comes to on the page."""
        await self.do("Runtime.evaluate", expression=script)
        asked = self._number
        async with asyncio.timeout(LIMIT):
            while (event := await self._socket.receive_json()).get("id") != asked:
                continue
        return event["result"]["result"].get("value")

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
    import aiohttp  # of the extra `web`

    process = start(folder)
    try:
        async with asyncio.timeout(LIMIT), aiohttp.ClientSession() as session:
            said = folder / "DevToolsActivePort"
            await eventually(lambda: said.exists() and said.read_text())  # it is made before it is written
            port = said.read_text().split()[0]

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
