"""Parts that drivers of several makers share: streams of bytes, TCP ports, and the messages around them.

`stream_driver.py`, `tcp_ports.py` and `web_socket.py` do I/O. All else is pure, but for the log of
`device_feed.py`: `controller_machine.py` is the machine of one robot of joints, `controller.py` what its
maker fills in.
"""
