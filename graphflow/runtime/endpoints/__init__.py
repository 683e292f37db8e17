"""Publishers, subscriptions, services and clients as they run. Begin with `endpoint`, which they share."""
