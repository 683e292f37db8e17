"""The views of nodes: the list, and the details, parameters, links, resource use and crash of one."""
