"""The ROS 2 side of Arboleda: everything that imports rclpy."""
