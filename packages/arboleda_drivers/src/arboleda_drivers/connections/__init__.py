"""Parts that drivers of several makers share: streams of bytes, TCP ports, and the messages around them.

`link.py`, `stream.py` and `tcp_arm.py` are pure, for machines of drivers; `stream_driver.py`, `tcp_ports.py`
and `web_socket.py` do their I/O.
"""
