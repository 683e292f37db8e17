"""ROS 2's interfaces as Python classes: `from graphflow.msgs.geometry_msgs.msg import Twist`.

Packages are folders of .msg, .srv and .action files: the bundled ones next to this file, a project's own in the
folder `interfaces/` next to its code. A class is built when it is first used, so a new definition works as soon
as its file is saved.
"""

from graphflow.msgs.finder import install

install()
