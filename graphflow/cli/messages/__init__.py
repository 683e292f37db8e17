"""Messages on the command line: typed, sent, shown, measured, plotted, recorded and played."""
