"""launch.substitutions, see `launch`; a file of its own so that editors find it."""

from graphflow.launchfiles.python.stand_ins import stand_in

__getattr__ = stand_in(__name__)
