"""launch_yaml for code that is shared with launch files: stand-ins, which remember what they are called with."""

from graphflow.launchfiles.python.stand_ins import stand_in

__getattr__ = stand_in(__name__)
