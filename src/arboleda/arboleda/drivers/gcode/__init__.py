"""The driver `gcode` without its line: machines of axes whose controller runs GRBL 1.1 or Marlin.

`machine.py` is what both dialects have in common, `grbl.py` and `marlin.py` what the driver makes of either,
`grbl_lines.py` and `marlin_lines.py` what is on the wire; `settings.py` has the keys of the plant file.
"""
