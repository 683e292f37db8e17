"""The units of the standard messages' fields, which their definitions give only in comments.

Source: REP 103 (SI units) and the comments of common_interfaces.
"""

from __future__ import annotations

from graphflow.introspect.messages.fields import Path
from graphflow.msgs import registry

_IN_METRES = {"x": "m", "y": "m", "z": "m"}
_UNITS: dict[str, dict[str, str]] = {
    "builtin_interfaces/msg/Duration": {"sec": "s", "nanosec": "ns"},
    "builtin_interfaces/msg/Time": {"sec": "s", "nanosec": "ns"},
    "geometry_msgs/msg/Accel": {"linear": "m/s²", "angular": "rad/s²"},
    "geometry_msgs/msg/Inertia": {"m": "kg", "com": "m"},
    "geometry_msgs/msg/Point": _IN_METRES,
    "geometry_msgs/msg/Point32": _IN_METRES,
    "geometry_msgs/msg/Pose2D": {"x": "m", "y": "m", "theta": "rad"},
    "geometry_msgs/msg/Transform": {"translation": "m"},
    "geometry_msgs/msg/Twist": {"linear": "m/s", "angular": "rad/s"},
    "geometry_msgs/msg/Wrench": {"force": "N", "torque": "N m"},
    "nav_msgs/msg/MapMetaData": {"resolution": "m"},
    "sensor_msgs/msg/BatteryState": {
        "voltage": "V",
        "temperature": "°C",
        "current": "A",
        "charge": "A h",
        "capacity": "A h",
        "design_capacity": "A h",
        "cell_voltage": "V",
        "cell_temperature": "°C",
    },
    "sensor_msgs/msg/FluidPressure": {"fluid_pressure": "Pa"},
    "sensor_msgs/msg/Illuminance": {"illuminance": "lx"},
    "sensor_msgs/msg/Imu": {"angular_velocity": "rad/s", "linear_acceleration": "m/s²"},
    "sensor_msgs/msg/LaserScan": {
        "angle_min": "rad",
        "angle_max": "rad",
        "angle_increment": "rad",
        "time_increment": "s",
        "scan_time": "s",
        "range_min": "m",
        "range_max": "m",
        "ranges": "m",
    },
    "sensor_msgs/msg/MagneticField": {"magnetic_field": "T"},
    "sensor_msgs/msg/NavSatFix": {"latitude": "°", "longitude": "°", "altitude": "m"},
    "sensor_msgs/msg/Range": {"field_of_view": "rad", "min_range": "m", "max_range": "m", "range": "m"},
    "sensor_msgs/msg/Temperature": {"temperature": "°C"},
    "turtlesim/msg/Pose": {
        "x": "m",
        "y": "m",
        "theta": "rad",
        "linear_velocity": "m/s",
        "angular_velocity": "rad/s",
    },
}


def unit(path: Path, type_name: str) -> str:
    """Return the unit of a field; empty if the type's definition gives none.

    Args:
        path: As from `introspect.fields`, checked against the type.
    """
    for part in path:
        if isinstance(part, int):
            continue
        if found := _UNITS.get(type_name, {}).get(part):
            return found
        type_name = next(f.type.base for f in registry.message_schema(type_name).fields if f.name == part)
        if "/" not in type_name:
            return ""
    return ""
