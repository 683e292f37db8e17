"""The closed-world analysis: the code that can end a wait, as far as the source of the node's class shows.

asyncio does not know who will set an event or a flag. If only the node's own code can, which the source suggests but
cannot prove (*closed-world assumption*), then the handlers with that code are the only ones to wait for, and the wait
gets edges in the wait-for graph. Reports that rest on it say LIKELY.

The analysis is conservative: anything that it cannot follow to the end makes the world open (`Unknown`), and the wait
counts as free. Begin with `wakers`.
"""
