"""The views, one module each; each says `VIEW = <its class>`."""
