"""A virtual gripper of ros2_control, with a part between its fingers: `arboleda virtual gripper`."""
