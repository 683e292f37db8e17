"""What nodes are made of: endpoints, clock, parameters, and the handlers' runs."""
