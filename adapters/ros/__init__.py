"""ROS 2: positions received over Zenoh from `rmw_zenoh`, or replayed from a bag. No ROS is needed."""

from adapters.ros.model_publisher import RosSending
from adapters.ros.ros_plugin import RosFeed
from adapters.ros.ros_vehicle import RosVehicles

__all__ = ["RosFeed", "RosSending", "RosVehicles"]
