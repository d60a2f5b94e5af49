"""The driver `dobot`: arms of Dobot's CR series at a controller V4, over TCP/IP.

`frames.py` and `replies.py` are what is on the wire, `machine.py` what the driver makes of it, `settings.py`
has the keys of the plant file.
"""
