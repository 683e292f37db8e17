"""A running graph, or a bag, in the viewer Rerun.

Read `archetypes` first: which message is shown as what. `markers` and `shapes` are those of visualization_msgs and of
robot descriptions, `recording` writes everything with its times, and `following` subscribes to a graph. Only this
package imports `rerun`, which comes with the extra `rerun`.
"""
