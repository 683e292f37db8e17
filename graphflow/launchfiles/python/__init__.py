"""Launch files in Python: stand-ins for ROS's launch packages, and what was recorded with them as launch actions.

Begin with `stand_ins`, which record, and `actions`, which converts. `supervisor.launch_recorder` runs a file with them.
"""
