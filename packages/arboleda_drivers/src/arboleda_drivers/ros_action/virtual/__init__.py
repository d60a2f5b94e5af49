"""Parts that the virtual controllers of ROS 2 actions share; `server.py` serves them over ROS 2."""
