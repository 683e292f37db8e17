"""Two hosts on one machine: network namespaces, joined by a cable that delays, loses and can be cut.

The cable is a pair of TUN devices, one in each namespace, whose packets a thread of the test passes on. It needs
nothing of the kernel but namespaces and TUN, and works the same wherever those are allowed.
"""

from __future__ import annotations

import fcntl
import heapq
import itertools
import os
import random
import selectors
import struct
import subprocess
import threading
import time
from contextlib import ExitStack
from typing import Self

_TUNSETIFF = 0x400454CA
_IFF_TUN = 0x0001
_IFF_NO_PI = 0x1000
_serial = itertools.count()


def why_not() -> str:
    """Why this machine cannot have hosts of the test's own; empty if it can."""
    try:
        with Hosts():
            return ""
    except (OSError, subprocess.CalledProcessError) as error:
        detail = getattr(error, "stderr", b"") or str(error).encode()
        return f"no network namespaces with a TUN device here: {detail.decode().strip()}"


class Host:
    """A network namespace with an address of its own on the cable."""

    def __init__(self, name: str, address: str) -> None:
        self.name, self.address = name, address

    def command(self, *words: str) -> list[str]:
        """A command, to be run on this host."""
        return ["ip", "netns", "exec", self.name, *words]


class Hosts:
    """`near` and `far`, and the cable between them.

    Attributes:
        delay: Seconds that a packet takes each way.
        loss: The share of packets that are lost.
        is_cut: Whether all are.
    """

    def __init__(self) -> None:
        mark = f"{os.getpid() % 100_000}{next(_serial)}"
        self.near = Host(f"gf{mark}n", "10.213.0.1")
        self.far = Host(f"gf{mark}f", "10.213.0.2")
        self.delay = 0.0
        self.loss = 0.0
        self.is_cut = False
        self._random = random.Random(1)
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        with self._stack:
            ends = [self._make(host, peer) for host, peer in ((self.near, self.far), (self.far, self.near))]
            wake, self._ender = os.pipe()
            self._stack.callback(os.close, wake)
            carrier = threading.Thread(target=self._carry, args=(*ends, wake), name="cable")
            carrier.start()
            self._stack.callback(carrier.join)
            self._stack.callback(os.close, self._ender)
            self._stack = self._stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _make(self, host: Host, peer: Host) -> int:
        """Make a host and its end of the cable; returns the descriptor of that."""
        _ip("netns", "add", host.name)
        self._stack.callback(_ip, "netns", "del", host.name)
        device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
        self._stack.callback(os.close, device)
        fcntl.ioctl(device, _TUNSETIFF, struct.pack("16sH", host.name.encode(), _IFF_TUN | _IFF_NO_PI))
        _ip("link", "set", host.name, "netns", host.name)
        _ip("-n", host.name, "address", "add", host.address, "peer", peer.address, "dev", host.name)
        _ip("-n", host.name, "link", "set", host.name, "mtu", "1400", "up")
        _ip("-n", host.name, "link", "set", "lo", "up")
        return device

    def _carry(self, near: int, far: int, wake: int) -> None:
        waiting: list[tuple[float, int, int, bytes]] = []  # (due, order, where to, packet)
        order = itertools.count()
        other = {near: far, far: near}
        with selectors.DefaultSelector() as selector:
            for fd in (near, far, wake):
                selector.register(fd, selectors.EVENT_READ)
            while True:
                limit = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
                for key, _ in selector.select(limit):
                    if key.fd == wake:
                        return
                    for packet in _packets(key.fd):
                        if not self.is_cut and self._random.random() >= self.loss:
                            due = time.monotonic() + self.delay
                            heapq.heappush(waiting, (due, next(order), other[key.fd], packet))
                while waiting and waiting[0][0] <= time.monotonic():
                    _, _, to, packet = heapq.heappop(waiting)
                    _write(to, packet)


def _packets(fd: int) -> list[bytes]:
    found: list[bytes] = []
    while len(found) < 64:
        try:
            found.append(os.read(fd, 2048))
        except BlockingIOError:
            break
    return found


def _write(fd: int, packet: bytes) -> None:
    try:
        os.write(fd, packet)
    except OSError:  # the queue is full, or the device is down: a packet lost, as on any cable
        return


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True, timeout=10.0)
