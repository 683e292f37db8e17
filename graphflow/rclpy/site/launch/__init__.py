"""Recording replacements for launch, for code that is shared with launch files."""

from graphflow.launchfiles.python.stand_ins import stand_in
from graphflow.runtime.mistakes import unrun
from graphflow.supervisor.launching.launch_service import LaunchService

__all__ = ["LaunchService"]
unrun.watch()
__getattr__ = stand_in(__name__)
