"""The network: small protocols, and their implementations over Zenoh and in memory. Only this package uses Zenoh."""
