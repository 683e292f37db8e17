"""Mutated payloads into every decoder: nothing but DecodeError comes out, and memory stays bounded.

`python -m benchmarks.fuzz 1000000 [SEED]` takes payloads of every bundled message, flips bits, cuts, repeats and
splices them, overwrites lengths, and decodes what that gives. It ends with 1 at the first other exception.
"""

from __future__ import annotations

import random
import resource
import sys
import time
import tracemalloc

from graphflow.errors import DecodeError
from graphflow.msgs import registry
from graphflow.wire.schema import Action, Message, Service

LARGEST = 64
"""Times its own size that a payload may make the decoder allocate, at most, and 1 MB."""


def names() -> list[str]:
    """Every message that is sent: those of .msg files, and the parts of services and actions."""
    found: list[str] = []
    for package in registry.packages():
        for kind in registry.KINDS:
            for name in registry.names_in(package, kind):
                match registry.interface(f"{package}/{kind}/{name}"):
                    case Message() as message:
                        found.append(message.name)
                    case Service() as service:
                        found += [m.name for m in service.messages[:3]]
                    case Action() as action:
                        found += [m.name for m in (action.goal, action.result, action.feedback_message)]
    return found


def filled(name: str, rng: random.Random) -> bytes:
    """A payload of a message with something in its sequences and strings."""
    values: dict[str, object] = {}
    for field in registry.message_schema(name).fields:
        type_ = field.type
        if type_.base in ("string", "wstring") and not type_.array:
            values[field.name] = "abc"[: type_.string_bound or 3]
        elif type_.array in ("unbounded", "bounded"):
            count = rng.randint(0, min(type_.size or 3, 3))
            if type_.base in ("string", "wstring"):
                values[field.name] = ["xy"] * count
            elif type_.is_primitive:
                values[field.name] = [True] * count if type_.base == "bool" else [1] * count
            else:
                values[field.name] = [{} for _ in range(count)]
    payload: bytes = registry.interface_class(name)(**values).to_bytes()
    return payload


def mutated(payload: bytes, other: bytes, rng: random.Random) -> bytes:
    """The payload with one to four things wrong."""
    data = bytearray(payload)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(data) + 1)
        match rng.randrange(7):
            case 0 if data:
                data[at % len(data)] ^= 1 << rng.randrange(8)
            case 1:
                del data[at:]
            case 2:
                data[at:at] = rng.randbytes(rng.randint(1, 9))
            case 3:
                data += data[at : at + 32]
            case 4:
                data[at : at + 4] = rng.choice([b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\0\0", b"\1\0\0\x80"])
            case 5:
                data[at:] = other[at:]
            case _ if len(data) > 1:
                data[1] = rng.randrange(3)
    return bytes(data)


def main() -> None:
    count, seed = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    rng = random.Random(seed)
    every = names()
    seeds = {name: [filled(name, rng) for _ in range(3)] for name in every}
    decoders = {name: registry.codec(name).decode for name in every}
    refused = accepted = 0
    began, before = time.monotonic(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    tracemalloc_every = 200
    worst = 0.0
    for i in range(count):
        name = rng.choice(every)
        payload = mutated(rng.choice(seeds[name]), rng.choice(seeds[rng.choice(every)]), rng)
        watched = i % tracemalloc_every == 0
        if watched:
            tracemalloc.start()
        try:
            decoders[name](payload)
            accepted += 1
        except DecodeError:
            refused += 1
        except BaseException as error:
            print(f"seed {seed}, number {i}: {name} from {payload.hex()}: {type(error).__name__}: {error}")
            sys.exit(1)
        if watched:
            _, peak = tracemalloc.get_traced_memory()
            tracemalloc.stop()
            worst = max(worst, peak / (len(payload) * LARGEST + 2**20))
            if worst > 1:
                print(f"seed {seed}, number {i}: {name} allocated {peak} bytes for a payload of {len(payload)}")
                sys.exit(1)
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(f"{count} payloads for {len(every)} types, seed {seed}: {refused} refused, {accepted} read, nothing else")
    print(
        f"{count / (time.monotonic() - began):.0f} a second; peak memory {before / 1024:.0f} -> {after / 1024:.0f} MB"
    )


if __name__ == "__main__":
    main()
