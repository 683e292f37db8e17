"""Projects and packages on the command line: create them, and find the node to run in them."""
