"""The console in a real, headless browser: a page that draws, keys that arrive, a tab that is closed."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest

from graphflow.transport.rendezvous import free_endpoint
from tests.cases import slow
from tests.conftest import LIMIT, Machine
from tests.headless import NEEDS_BROWSER, browser

aiohttp = pytest.importorskip("aiohttp", reason="the extra `web` is not installed")

pytestmark = [pytest.mark.real, NEEDS_BROWSER]


async def consoles(machine: Machine, count: int) -> None:
    async with asyncio.timeout(LIMIT):
        while len(json.loads(await asyncio.to_thread(machine.run, "ls", "--json"))[0]["consoles"]) != count:
            await asyncio.sleep(0.1)


@slow
def test_a_console_in_a_tab(machine: Machine, tmp_path: Path) -> None:
    """A tab shows the graph and takes keys; its console ends with it. Pages of other origins are refused."""
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
