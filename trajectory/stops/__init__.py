"""Emergency stops on the path."""

from trajectory.stops.stop_on_path import EmergencyStop, emergency_stop

__all__ = [
    "EmergencyStop",
    "emergency_stop",
]
