"""The contract of all drivers, which a driver of your own goes through, too: `DriverContract` has its cases.

The plant is a real one, with threads and a real clock. It has one device, whose controller your test plays by
hand. Only what fails waits: for 90 s, or for ARBOLEDA_PATIENCE_S.
"""

from .bench import Bench, Device, open_shop
from .contract import DriverContract

__all__ = ["Bench", "Device", "DriverContract", "open_shop"]
