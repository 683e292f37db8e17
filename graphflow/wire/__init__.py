"""rmw_zenoh's wire protocol as functions on bytes and strings."""
