"""The `console:` section of graph files: windows and panes as data, read without starting the console.

Begin with `views`, the table of views that a pane may show. Imports the pure layer and `markup`.
"""
