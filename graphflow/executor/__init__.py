"""How handlers run: clocks, groups, the runs themselves, and the ledger of what calls, waits and holds."""
