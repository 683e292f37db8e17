"""The page on which turtles are watched."""

from __future__ import annotations

import asyncio
import http.client
import json
import logging
import re
import socket
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import pytest

from graphflow.testing import Graph
from nodes.turtle_view import BODY_BOUND, HOST, TurtleView
from nodes.turtlesim import TurtleSim
from tests.cases import slow
from tests.headless import NEEDS_BROWSER, browser

ARROW_UP = 38
NOTHING: Mapping[str, str] = MappingProxyType({})


class Watched:
    """A page and its commands."""

    def __init__(self) -> None:
        self.driven: list[tuple[float, float]] = []
        self.view = TurtleView(0, lambda: "<svg/>", lambda linear, angular: self.driven.append((linear, angular)))
        self.port = int(self.view.url.rstrip("/").rpartition(":")[2])

    def ask(
        self, method: str, path: str, body: bytes | None = None, headers: Mapping[str, str] = MappingProxyType({})
    ) -> tuple[int, str]:
        connection = http.client.HTTPConnection(HOST, self.port, timeout=10.0)
        connection.request(method, path, body, dict(headers))
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, text


@pytest.fixture
def watched() -> Watched:
    return Watched()


def test_the_page_and_its_pictures(watched: Watched) -> None:
    """All other paths are refused."""
    assert watched.view.url.startswith("http://127.0.0.1:")
    assert "arrow keys" in watched.ask("GET", "/")[1]
    assert watched.ask("GET", "/picture") == (200, "<svg/>")
    assert watched.ask("GET", "/etc/passwd")[0] == 404
    watched.view.close()
    with pytest.raises(ConnectionError):
        watched.ask("GET", "/")


def test_steering(watched: Watched) -> None:
    """Keys are sent as two numbers; other content is refused."""
    assert watched.ask("POST", "/drive", b'{"linear": 2, "angular": -1.5}') == (200, "")
    for body in (b"", b"[]", b'{"linear": "x", "angular": 0}', b'{"linear": 1}', b"1" * (BODY_BOUND + 1), b"{"):
        assert watched.ask("POST", "/drive", body)[0] == 400
    assert watched.driven == [(2.0, -1.5)]
    watched.view.close()


@slow
@pytest.mark.parametrize("headers", [{"Origin": "http://example.org"}, {"Host": "example.org"}, {"Origin": "null"}])
def test_a_strangers_page_gets_nothing(watched: Watched, headers: dict[str, str]) -> None:
    """Any page open in the browser could send requests."""
    assert watched.ask("GET", "/picture", headers=headers)[0] == 403
    assert watched.ask("POST", "/drive", b'{"linear": 2, "angular": 0}', headers=headers)[0] == 403
    assert watched.driven == []
    watched.view.close()


def test_a_port_that_is_taken() -> None:
    """It is an error of the system's."""
    with socket.create_server((HOST, 0)) as taken, pytest.raises(OSError, match="in use"):
        TurtleView(taken.getsockname()[1], lambda: "", lambda linear, angular: None)


async def test_turtlesim_shows_its_page(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Its address is logged, the picture is the world's, and keys drive the first turtle."""
    caplog.set_level(logging.INFO)
    node = TurtleSim(view=True)
    await graph.start(node)
    [port] = [int(found[1]) for m in caplog.messages if (found := re.search(r"http://127.0.0.1:(\d+)/", m))]

    def ask(method: str, path: str, body: bytes | None = None) -> str:
        connection = http.client.HTTPConnection(HOST, port, timeout=10.0)
        connection.request(method, path, body)
        return connection.getresponse().read().decode()

    assert "turtle1" in await asyncio.to_thread(ask, "GET", "/picture")
    before = node.world.turtles["turtle1"].position
    await asyncio.to_thread(ask, "POST", "/drive", json.dumps({"linear": 2.0, "angular": 0.0}).encode())
    await graph.clock.advance(0.5)
    assert node.world.turtles["turtle1"].position[0] > before[0] + 0.5
    await graph.stop(node)
    with pytest.raises(ConnectionError):
        await asyncio.to_thread(ask, "GET", "/")


async def test_turtlesim_without_a_view_serves_nothing(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """As before."""
    caplog.set_level(logging.INFO)
    await graph.start(TurtleSim())
    assert not any("http://" in message for message in caplog.messages)


@slow
@pytest.mark.real
@NEEDS_BROWSER
async def test_in_a_browser(graph: Graph, caplog: pytest.LogCaptureFixture, tmp_path: Path) -> None:
    """The page draws the turtle, and an arrow key moves it."""
    pytest.importorskip("aiohttp", reason="the extra `web` is not installed")
    caplog.set_level(logging.INFO)
    node = TurtleSim(view=True)
    await graph.start(node)
    [url] = [found[0] for m in caplog.messages if (found := re.search(r"http://[^ ]+", m))]
    async with browser(tmp_path / "browser") as open_tab, open_tab(url) as tab:
        async with asyncio.timeout(45.0):
            while await tab.evaluate("document.querySelectorAll('#picture svg title').length") != 1:
                await asyncio.sleep(0.05)
            await tab.press("ArrowUp", ARROW_UP)
            while node.world.turtles["turtle1"].position[0] < 6.5:
                await asyncio.sleep(0.05)
                await graph.clock.advance(0.05)
    await graph.stop(node)
