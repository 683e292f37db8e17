"""How handlers run: clocks, groups, the runs themselves, and the ledger of who calls, waits and holds."""
