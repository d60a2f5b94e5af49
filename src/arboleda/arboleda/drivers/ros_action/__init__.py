"""Parts that drivers of ROS actions share, without ROS 2: one server, one goal at a time, proof by
measurement.

`machine.py` is what a driver makes of a server's answers; a `Mover` is what its goals move, and what
shows where that is: an arm, a gripper, a mobile base. What speaks ROS 2 is in `arboleda_ros`.
"""
