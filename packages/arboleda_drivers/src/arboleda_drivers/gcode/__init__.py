"""The driver `gcode`: machines of axes whose controller runs GRBL 1.1, Marlin or Klipper.

`machine.py` is what the dialects have in common; `grbl.py`, `marlin.py` and `moonraker.py` are what the
driver makes of each, and the `_lines.py` beside it what is on the wire; `settings.py` has the keys of the
plant file.
"""
