"""What `ros2 launch arboleda_bringup plant.launch.py` starts."""
