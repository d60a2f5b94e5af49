"""The driver `ros`: a device by its own actions, services and topics of ROS 2, mapped in the plant file.

`settings.py` has the keys of the plant file, `checks.py` what does not fit a device, `types.py` what does not
fit the types of ROS 2. `machine.py` is what the driver makes of goals, answers and messages; `adapter.py`
speaks ROS 2.
"""
