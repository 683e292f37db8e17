"""The server to which viewers connect: it admits them, and passes on their requests."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import re
from http import HTTPStatus
from pathlib import Path
from typing import Protocol

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from graphflow.errors import GraphflowError, TransportError, UsageFault, printable
from graphflow.viewer import protocol
from graphflow.viewer.assets import asset
from graphflow.viewer.client import Client

logger = logging.getLogger("graphflow")

GRACE = 1.0
"""Seconds to wait for viewers to close their connections."""
CLIENTS_BOUND = 32
"""Maximum number of viewers."""
MESSAGE_BOUND = 16 << 20
"""Maximum bytes of one message from a viewer."""
PAGES = re.compile(r"https://([a-z0-9-]+\.)*foxglove\.dev|https?://(localhost|127\.0\.0\.1|\[::1\])(:\d+)?")
"""Web pages allowed to connect, besides the user's own list; programs always are. The check is needed since any page
can make a browser connect to this machine, including downloaded files (`file://`) and browser extensions.
"""


class Source(Protocol):
    """The channels that viewers see, of a graph or of a bag."""

    def greet(self, client: Client) -> None:
        """Tell a new client what there is."""

    def handle(self, client: Client, request: protocol.ClientMessage) -> None:
        """Carry out a client's request.

        Raises:
            GraphflowError: The request cannot be carried out; the text is for the client.
        """

    def leave(self, client: Client) -> None:
        """Forget a client that has left."""


class ViewerServer:
    """Serves viewers from `open` to `close`.

    Args:
        pages: Origins of further web pages that may connect: `https://viewer.example`.
    """

    def __init__(self, source: Source, pages: frozenset[str] = frozenset()) -> None:
        self._source, self._pages = source, pages
        self.clients: set[Client] = set()
        self._server: Server | None = None

    async def open(self, host: str, port: int) -> int:
        """Start the server; return its port.

        Args:
            port: 0 for any free one.

        Raises:
            TransportError: The server cannot listen there.
        """
        try:
            self._server = await serve(
                self._serve,
                host,
                port,
                subprotocols=[Subprotocol(name) for name in protocol.SUBPROTOCOLS],
                process_request=self._admit,
                max_size=MESSAGE_BOUND,
                compression=None,  # compression would delay all other clients, and images do not shrink
                logger=logging.getLogger("graphflow.viewer.websockets"),
            )
        except (OSError, UnicodeError) as error:
            is_taken = isinstance(error, OSError) and error.errno == errno.EADDRINUSE
            hint = "; take another --port" if is_taken else "; --host is an address of this machine"
            why = ("the port is taken" if is_taken else _reason(error)) + hint
            raise TransportError(f"cannot listen for viewers on {host}:{port}: {why}") from None
        found: int = next(iter(self._server.sockets)).getsockname()[1]
        return found

    async def close(self) -> None:
        """Stop the server and disconnect the viewers."""
        if self._server is not None:
            self._server.close()
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(GRACE):
                    await self._server.wait_closed()
            for client in self.clients:  # waiting for clients that do not read would never end
                client.abort()
            await self._server.wait_closed()

    def broadcast(self, message: str | bytes) -> None:
        """Send a control message to all clients."""
        for client in self.clients:
            client.send_control(message)

    def _admit(self, connection: ServerConnection, request: Request) -> Response | None:
        """Reject a page of unknown origin, and clients beyond the limit."""
        origin = request.headers.get("Origin", "")
        if origin and origin not in self._pages and not PAGES.fullmatch(origin):  # programs send no Origin
            logger.warning(
                "a web page of %s was refused; if it is your viewer, allow it by --allow-page %s",
                *[printable(origin[:200])] * 2,
            )
            return connection.respond(HTTPStatus.FORBIDDEN, "this page is not allowed; see graphflow view --help\n")
        if len(self.clients) >= CLIENTS_BOUND:
            return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, f"there are already {CLIENTS_BOUND} viewers\n")
        return None

    async def _serve(self, connection: ServerConnection) -> None:
        client = Client(connection)
        self._source.greet(client)
        self.clients.add(client)
        writing = asyncio.ensure_future(client.write())
        try:
            async for message in connection:
                try:
                    self._handle(client, message)
                except GraphflowError as error:
                    client.warn(str(error))
        except ConnectionClosed:
            logger.debug("a viewer has disconnected without a closing handshake")
        finally:
            self.clients.discard(client)
            writing.cancel()
            client.close()
            self._source.leave(client)

    def _handle(self, client: Client, message: str | bytes) -> None:
        request = protocol.read_text(message) if isinstance(message, str) else protocol.read_bytes(message)
        if isinstance(request, protocol.FetchAsset):
            client.spawn(lambda: _send_asset(client, request))
        else:
            self._source.handle(client, request)


async def _send_asset(client: Client, request: protocol.FetchAsset) -> None:
    async with client.one_file:  # many large files at once would take much memory
        try:
            data, why = await asyncio.to_thread(asset, request.uri, Path.cwd()), ""
        except UsageFault as error:
            data, why = b"", str(error)
        client.send_control(protocol.asset_frame(request.request_id, data, why))
        await client.drained()


def _reason(error: OSError | UnicodeError) -> str:
    text = (isinstance(error, OSError) and error.strerror) or str(error)
    return text.rpartition(": ")[2]
