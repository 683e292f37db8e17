"""The texts of graph files and launch files: YAML and XML as trees whose values know their places, and substitutions.

Begin with `source` (YAML) and `xml_source`; `tree` is what both become; `substitutions` resolves `$(...)` in texts.
Imports the pure layer and `workspace`.
"""
