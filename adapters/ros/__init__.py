"""ROS 2: positions heard over Zenoh, as `rmw_zenoh` speaks it, or replayed from a bag. No ROS is needed."""

from adapters.ros.feed import RosFeed
from adapters.ros.sending import RosSending
from adapters.ros.vehicle import RosVehicles

__all__ = ["RosFeed", "RosSending", "RosVehicles"]
