"""The deadlock detector: it takes snapshots of live processes, searches them, and reports each deadlock once.

Begin with `search`. A snapshot (`snapshot`) is built from the ledger, from asyncio's state (`asyncio_frames`) and from
the source (`closed_world`); `machines.waits` has the theory. The watchdog, the stalls and the races are detectors of
their own. Nodes are seen only through `protocols`.
"""
