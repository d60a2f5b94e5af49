"""Drawn plants with cells of devices: kinds, cells, zones and recipes, in Python and as XML."""

from __future__ import annotations

from .drawing import draw
from .drawn import DrawnDevices, Form, can_be_xml
from .reductions import smaller

__all__ = ["DrawnDevices", "Form", "can_be_xml", "draw", "smaller"]
