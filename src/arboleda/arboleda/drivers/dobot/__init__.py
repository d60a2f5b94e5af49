"""The driver `dobot`: arms of Dobot's CR series at a controller of version 4, over its TCP/IP interface.

`frames` and `replies` are what is on the wire, `machine` is what the driver makes of it, `adapter` has the
sockets.
"""
