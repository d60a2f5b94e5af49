"""The drivers `navigate_to_pose` and `follow_waypoints` without ROS 2: a mobile base that Nav2 drives.

`machine.py` is what the drivers make of commands and of where the base is, `localisation.py` finds that out,
`settings.py` has the keys of the plant file. What speaks ROS 2 is `arboleda_ros/nav2.py`.
"""
