"""Parts that drivers of ROS actions share: one server, one goal at a time, proof by measurement.

`machine.py` is what a driver makes of a server's answers; a `Mover` is what its goals move, and what shows
where that is: an arm, a gripper, a mobile base. `action_client.py`, `health_link.py` and `joint_states.py`
speak ROS 2.
"""
