"""The data that views show: the supervisor's events, the logs, the live graph and single topics.

Begin with `hub`, which holds one of each for all views of a console.
"""
