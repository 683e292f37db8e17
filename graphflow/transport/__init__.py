"""The network: small protocols, and the two rooms that fulfil them. Only this package knows Zenoh."""
