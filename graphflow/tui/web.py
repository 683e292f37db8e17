"""The console in a browser on this machine; each tab is a separate console."""

from __future__ import annotations

import shlex
from collections.abc import Awaitable, Callable, Sequence
from urllib.parse import urlsplit

from aiohttp import web
from textual_serve.server import Server

HOST = "127.0.0.1"

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class OwnPageServer(Server):
    """A server that serves only its own page. There is no password, so that any page in the browser could connect."""

    async def _make_app(self) -> web.Application:
        app: web.Application = await super()._make_app()
        hosts = {f"{name}:{self.port}" for name in (HOST, "localhost")}

        @web.middleware
        async def refuse_others(request: web.Request, handler: Handler) -> web.StreamResponse:
            origin = request.headers.get("Origin")
            # The host, too: another name may be made to resolve to this address (DNS rebinding).
            if request.host not in hosts or (origin is not None and urlsplit(origin).netloc not in hosts):
                raise web.HTTPForbidden(text="this console can be used from its own page only")
            return await handler(request)

        app.middlewares.append(refuse_others)
        return app


def serve(words: Sequence[str], port: int) -> None:
    """Serve a page whose tabs each run a command; return after Ctrl-C.

    Args:
        words: The command line.
    """
    OwnPageServer(shlex.join(words), host=HOST, port=port, title="graphflow").serve()
