"""The network: small protocols and two implementations of them. Only this package knows Zenoh."""
