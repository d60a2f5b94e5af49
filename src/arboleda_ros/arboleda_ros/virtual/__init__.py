"""Virtual controllers of actions: plain action servers of rclpy around the machines of `arboleda.virtual`."""
