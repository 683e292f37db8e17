"""Recording replacements for launch_xml, for code that is shared with launch files."""

from graphflow.launchfiles.python.stand_ins import stand_in

__getattr__ = stand_in(__name__)
