"""The kinds in Python that come with Arboleda; each is written as a user's own would be."""

from .conveyor import conveyor
from .effector import effector
from .gripper import gripper
from .sensors import camera, sensor

SHIPPED = (gripper, effector, conveyor, camera, sensor)
