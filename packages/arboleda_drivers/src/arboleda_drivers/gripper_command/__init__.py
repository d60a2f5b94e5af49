"""The driver `gripper_command`: a gripper of ros2_control.

`machine.py` is what the driver makes of commands and joint states, `settings.py` has the keys of the plant
file. `adapter.py` speaks ROS 2.
"""
