"""The driver `gcode` without its line: machines of axes whose controller runs GRBL 1.1.

`lines.py` is what is on the wire, `machine.py` what the driver makes of it, `settings.py` has the keys of the
plant file.
"""
