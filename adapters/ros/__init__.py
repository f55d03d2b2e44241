"""ROS 2: positions received over Zenoh from `rmw_zenoh`, or replayed from a bag. No ROS is needed."""

from adapters.ros.feed import RosFeed
from adapters.ros.sending import RosSending
from adapters.ros.vehicle import RosVehicles

__all__ = ["RosFeed", "RosSending", "RosVehicles"]
