"""Virtual controllers of other makers, over their own protocols: `arboleda virtual`.

A folder per controller: `machine.py` is pure (what it does, with its faults), `sockets.py` or the like is the
thin rest, `command.py` its command. All are listed in `cli/virtual.py`.
"""
