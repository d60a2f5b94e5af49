"""The driver `follow_joint_trajectory` without ROS 2: an arm of ros2_control.

`machine.py` is what the driver makes of commands and joint states, `settings.py` has the keys of the plant
file. What speaks ROS 2 is `arboleda_ros/joint_trajectory.py`.
"""
