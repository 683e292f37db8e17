"""Projects and packages on the command line: made, and searched for the node that is meant."""
