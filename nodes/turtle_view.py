"""A web page that shows the turtles live and steers the first one with the arrow keys.

The page requests pictures repeatedly and sends key presses. It is served on loopback only and accepts requests only
from itself, since any page open in the browser could send some.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

HOST = "127.0.0.1"
BODY_BOUND = 200
"""Longest request body, in bytes."""

PAGE = """\
<!doctype html>
<meta charset="utf-8">
<title>turtlesim</title>
<style>
  body { margin: 0; height: 100vh; display: grid; place-content: center; justify-items: center; gap: 12px;
         background: #1c1f26; color: #c8ccd4; font: 14px system-ui, sans-serif; }
  #picture svg { display: block; border-radius: 6px; width: min(80vmin, 800px); height: auto; }
</style>
<div id="picture"></div>
<div id="hint">arrow keys drive turtle1</div>
<script>
const held = new Set();
const drives = { ArrowUp: [2, 0], ArrowDown: [-2, 0], ArrowLeft: [0, 2], ArrowRight: [0, -2] };
addEventListener("keydown", e => { if (e.key in drives) { held.add(e.key); e.preventDefault(); } });
addEventListener("keyup", e => held.delete(e.key));
addEventListener("blur", () => held.clear());
async function turn() {
  try {
    const picture = await fetch("/picture");
    document.getElementById("picture").innerHTML = await picture.text();
    document.getElementById("hint").textContent = "arrow keys drive turtle1";
    if (held.size) {
      const [linear, angular] = [...held].reduce(([l, a], key) => [l + drives[key][0], a + drives[key][1]], [0, 0]);
      await fetch("/drive", { method: "POST", body: JSON.stringify({ linear, angular }) });
    }
    setTimeout(turn, 50);
  } catch {
    document.getElementById("hint").textContent = "turtlesim has gone";
    setTimeout(turn, 1000);
  }
}
turn();
</script>
"""


class TurtleView:
    """The web server of the page, in threads of its own.

    Args:
        port: The port to listen on; 0 for any free port.
        picture: Returns the world as SVG; called from threads.
        drive: Takes a linear and an angular speed, in m/s and rad/s; called from threads.

    Raises:
        OSError: The port is taken.
    """

    def __init__(self, port: int, picture: Callable[[], str], drive: Callable[[float, float], None]) -> None:
        self._server = _Server((HOST, port), _Handler)
        self._server.picture, self._server.drive = picture, drive
        threading.Thread(target=self._server.serve_forever, name="turtle-view", daemon=True).start()

    @property
    def url(self) -> str:
        """The page's address."""
        return f"http://{HOST}:{self._server.server_port}/"

    def close(self) -> None:
        """Stop serving."""
        self._server.shutdown()
        self._server.server_close()


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    picture: Callable[[], str]
    drive: Callable[[float, float], None]


class _Handler(BaseHTTPRequestHandler):
    timeout = 10.0
    server: _Server

    def do_GET(self) -> None:
        if not self._is_own_page():
            return
        if self.path == "/":
            self._answer(HTTPStatus.OK, "text/html; charset=utf-8", PAGE)
        elif self.path == "/picture":
            self._answer(HTTPStatus.OK, "image/svg+xml", self.server.picture())
        else:
            self._answer(HTTPStatus.NOT_FOUND, "text/plain", "the pages are / and /picture\n")

    def do_POST(self) -> None:
        if not self._is_own_page():
            return
        try:
            size = int(self.headers.get("Content-Length", ""))
            wanted = json.loads(self.rfile.read(size) if 0 <= size <= BODY_BOUND else b"{}")
            linear, angular = float(wanted["linear"]), float(wanted["angular"])
        except (ValueError, TypeError, KeyError, RecursionError, OverflowError):
            self._answer(HTTPStatus.BAD_REQUEST, "text/plain", 'write {"linear": 2.0, "angular": 0.0}\n')
            return
        self.server.drive(linear, angular)
        self._answer(HTTPStatus.OK, "text/plain", "")

    def _is_own_page(self) -> bool:
        """Whether a request comes from the page itself or from no page; others are refused."""
        hosts = {f"{name}:{self.server.server_port}" for name in (HOST, "localhost")}
        origin = self.headers.get("Origin")
        if self.headers.get("Host") in hosts and (origin is None or urlsplit(origin).netloc in hosts):
            return True
        self._answer(HTTPStatus.FORBIDDEN, "text/plain", "requests are accepted only from this page\n")
        return False

    def _answer(self, status: HTTPStatus, kind: str, text: str) -> None:
        body = text.encode()
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Log nothing: there are many requests a second."""
