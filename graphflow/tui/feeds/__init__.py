"""Sources of the data in views: the supervisor's events, the logs, the running graph and single topics.

Begin with `hub`, which owns one of each for all views of a console.
"""
