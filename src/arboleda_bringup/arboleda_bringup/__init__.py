"""The nodes of `ros2 launch arboleda_bringup plant.launch.py`."""
