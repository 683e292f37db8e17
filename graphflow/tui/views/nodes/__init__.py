"""The views of nodes: the list of them, and the details, parameters, links, costs and crash of one."""
