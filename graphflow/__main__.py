"""`python -m graphflow` is `graphflow`."""

from graphflow.cli.entry import main

main()
