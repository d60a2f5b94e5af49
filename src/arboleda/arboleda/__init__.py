"""Arboleda runs robot cells by behavior trees on ROS 2."""

__version__ = "0.1.0"
