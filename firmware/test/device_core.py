"""The core's board of a declared device behind its C interface, for ctypes."""

from __future__ import annotations

import ctypes
from functools import cache

from .core import load, run_in


class DecodedOrder(ctypes.Structure):
    """`struct DecodedOrder` of test/scripted_device.cpp."""

    _fields_ = (
        ("well_formed", ctypes.c_int),
        ("known", ctypes.c_int),
        ("has_seq", ctypes.c_int),
        ("has_epoch", ctypes.c_int),
        ("has_heard", ctypes.c_int),
        ("seq", ctypes.c_uint32),
        ("epoch", ctypes.c_uint32),
        ("heard", ctypes.c_uint32),
        ("verb", ctypes.c_int),
        ("value", ctypes.c_double),
        ("token", ctypes.c_char * 13),
    )


@cache
def library() -> ctypes.CDLL:
    """That of a valve's board."""
    loaded = load("libscripted_device.so")
    loaded.arboleda_decode_order.argtypes = (
        ctypes.c_char_p,
        ctypes.c_size_t,
        ctypes.POINTER(DecodedOrder),
    )
    return loaded


def run(lines: list[str]) -> list[str]:
    """What the core's board said under a script, a line each."""
    return run_in(library().arboleda_device_run, lines)


def decode(raw: bytes) -> DecodedOrder:
    """What the core makes of an order."""
    decoded = DecodedOrder()
    library().arboleda_decode_order(raw, len(raw), ctypes.byref(decoded))
    return decoded
