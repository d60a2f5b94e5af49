"""The server of the original Snap7 (in C), with a small program; runs with the wheel python-snap7 1.4.1.

Prints its port; for each line that comes, prints the bytes of DB2.
"""

from __future__ import annotations

import ctypes
import socket
import sys
import threading

from snap7.server import Server
from snap7.types import srvAreaDB

SCAN_S = 0.005
SIZE = 64
DONE, REJECTED, ACCEPTED, REASON, PART_AT = 0, 2, 6, 8, 18  # of DB1
NUMBER = 8  # of DB2
LOAD, UNKNOWN, ENTRY = 1, 3, 1


def word(block: ctypes.Array[ctypes.c_uint8], at: int, value: int | None = None) -> int:
    """The word at a byte, after it was set to a value, if there is one."""
    if value is not None:
        block[at], block[at + 1] = value >> 8, value & 255
    return block[at] << 8 | block[at + 1]


def scan(shows: ctypes.Array[ctypes.c_uint8], orders: ctypes.Array[ctypes.c_uint8]) -> None:
    """Take a new number: a load is done at once, anything else is rejected."""
    number = word(orders, NUMBER)
    if number in (word(shows, DONE), word(shows, REJECTED)):
        return
    if orders[0] != LOAD:
        word(shows, REASON, UNKNOWN)
        word(shows, REJECTED, number)
        return
    word(shows, ACCEPTED, number)
    word(shows, PART_AT, ENTRY)
    word(shows, DONE, number)


def main() -> None:
    shows, orders = ((ctypes.c_uint8 * SIZE)() for _ in range(2))
    orders[12] = 0b1010_0000  # neighbours of the bit of the halt
    server = Server(log=False)
    server.register_area(srvAreaDB, 1, shows)
    server.register_area(srvAreaDB, 2, orders)
    with socket.create_server(("127.0.0.1", 0)) as found:
        port = found.getsockname()[1]
    server.start_to("127.0.0.1", port)
    over = threading.Event()

    def run() -> None:
        while not over.wait(SCAN_S):
            scan(shows, orders)

    threading.Thread(target=run, daemon=True).start()
    print(port, flush=True)
    for _ in sys.stdin:
        print(bytes(orders).hex(), flush=True)
    over.set()
    server.stop()


main()
