"""The views of topics: the list, and the messages, rate and curves of one."""
