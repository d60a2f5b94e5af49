"""Drivers of other makers' devices: a folder for each maker, with its driver and its virtual controller.

In a folder, `machine.py` is the driver without I/O, `settings.py` has its keys in a plant file, `adapter.py`
reaches the device, and `virtual/` plays the device: `arboleda virtual`.
"""
