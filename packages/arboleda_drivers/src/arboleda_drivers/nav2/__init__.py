"""The drivers `navigate_to_pose` and `follow_waypoints`: a mobile base that Nav2 drives.

`machine.py` is what the drivers make of commands and of where the base is, `localisation.py` finds that out,
`settings.py` has the keys of the plant file. `adapter.py` speaks ROS 2.
"""
