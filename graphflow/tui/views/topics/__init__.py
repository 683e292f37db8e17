"""The views of topics: the list of them, and the messages, rate and curves of one."""
