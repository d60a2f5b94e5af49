"""The driver `pylabrobot`: laboratory devices that PyLabRobot drives.

`paths.py` and `reading.py` are what the machine shows, `settings.py` has the keys of the plant file,
`messages.py` is between the driver and the machine's event loop, `machine.py` what the driver makes of it.
"""
