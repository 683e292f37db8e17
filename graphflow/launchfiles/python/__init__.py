"""Launch files in Python: stand-ins for ROS's launch packages that record calls, and their conversion.

Begin with `stand_ins`, which record, and `actions`, which converts. `supervisor.launch_recorder` runs a file with them.
"""
