"""The search for waits that never end: it reads the ledger and the source, and knows of nodes only what it asks for."""
