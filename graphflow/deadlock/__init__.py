"""The search for waits that never end: it reads the ledger and the source, and sees nodes only through protocols."""
