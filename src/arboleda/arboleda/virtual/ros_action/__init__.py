"""Parts that the virtual controllers of ROS 2 actions share; their servers are in `arboleda_ros.virtual`."""
