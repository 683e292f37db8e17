"""Robot descriptions: URDF files, those written with xacro, and the poses of a robot's links.

Read `robot` first: links, joints and the poses that joints give. `urdf` reads the XML, each mistake with its line;
`files` reads files, expands xacro (extra `urdf`) and finds meshes in packages. Knows no node; the nodes are
`nodes/robot_state_publisher.py` and `nodes/joint_state_publisher.py`. May import `tf`, and everything below the
runtime; the only package that imports xacro.
"""

from graphflow.description.files import mesh_file, read_robot
from graphflow.description.robot import Joint, Link, Robot
from graphflow.description.urdf import parse

__all__ = ["Joint", "Link", "Robot", "mesh_file", "parse", "read_robot"]
