"""Arboleda runs robot cells by behavior trees on ROS 2."""

import logging

__version__ = "0.1.0"

# A program that uses these packages and sets up no logging of its own is not spoken to on its standard error.
logging.getLogger("arboleda").addHandler(logging.NullHandler())
