"""Endpoints: publishers, subscriptions, services and clients. Start with `endpoint`, their common base."""
