"""Actions: servers, clients, and the reasons of rejected and aborted goals."""
