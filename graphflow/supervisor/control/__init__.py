"""The control socket: its protocol, the clients of a graph, and the orders that workers carry out."""
