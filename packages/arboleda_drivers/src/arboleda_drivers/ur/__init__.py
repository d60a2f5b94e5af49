"""The driver `ur`: arms of Universal Robots, by dashboard, RTDE and programs.

`rtde.py`, `primary.py` and `programs.py` are what is on the wire, `arm_state.py` what a frame shows,
`work.py` and `machine.py` what the driver makes of it, `settings.py` has the keys of the plant file.
"""
