"""Parts that virtual controllers of all makers share, and the command `arboleda virtual`, which finds them.

A virtual controller is in the folder of its maker: `virtual/machine.py` is pure (what it does, with its
faults), `sockets.py` or the like is the thin rest, `command.py` its command.
"""
