"""The syntax of graph files and launch files: YAML and XML as trees of values with places, and substitutions.

Begin with `source` (YAML) and `xml_source`; `tree` is what both become; `substitutions` resolves `$(...)` in texts.
Imports the pure layer and `workspace`.
"""
