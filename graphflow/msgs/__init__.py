"""ROS 2's interfaces as Python classes: `from graphflow.msgs.geometry_msgs.msg import Twist`.

Packages are folders of .msg, .srv and .action files: the bundled ones beside this file, a project's own in the
folder `interfaces/` beside its code. A class is made when it is first asked for, so a new definition works as soon
as its file is saved.
"""

from graphflow.msgs.finder import install

install()
