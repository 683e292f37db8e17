"""launch for code that is shared with launch files: stand-ins, which remember what they are called with."""

from graphflow.runtime import unrun
from graphflow.supervisor.launch_service import LaunchService
from graphflow.supervisor.launch_stand_ins import stand_in

__all__ = ["LaunchService"]
unrun.watch()
__getattr__ = stand_in(__name__)
