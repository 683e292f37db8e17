"""Execution of handlers: clocks, concurrency groups, runners, activities, and the ledger of waits."""
