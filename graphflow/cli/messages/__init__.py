"""Messages on the command line: publish, print, measure, plot, record and play them."""
