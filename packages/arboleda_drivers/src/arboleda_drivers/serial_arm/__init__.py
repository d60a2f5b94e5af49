"""The driver `serial_arm`: arms of bus servos, Feetech's STS series or Dynamixel's X series.

`packets.py` has the frames of both protocols, `servos.py` the registers of both makers, `machine.py` what the
driver makes of them, `work.py` its moves, `position_watch.py` which of their positions are old, `settings.py`
the keys of the plant file.
"""
