"""The core behind its C interface, for ctypes."""

from __future__ import annotations

import ctypes
from functools import cache
from pathlib import Path
from typing import Any

BUILD = Path(__file__).parents[1] / "build"
CAPACITY = 1 << 22
JOINTS = 6
RAMP = {
    "arboleda_speed": (ctypes.c_float,),
    "arboleda_acceleration": (ctypes.c_float,),
    "arboleda_move": (ctypes.c_int32,),
    "arboleda_stop": (),
    "arboleda_here": (ctypes.c_int32,),
    "arboleda_step": (ctypes.c_int64, ctypes.c_int64),
    "arboleda_position": (),
}


class Decoded(ctypes.Structure):
    """`struct Decoded` of test/scripted.cpp."""

    _fields_ = (
        ("well_formed", ctypes.c_int),
        ("has_seq", ctypes.c_int),
        ("has_epoch", ctypes.c_int),
        ("has_heard", ctypes.c_int),
        ("seq", ctypes.c_uint32),
        ("epoch", ctypes.c_uint32),
        ("heard", ctypes.c_uint32),
        ("q_deg", ctypes.c_double * JOINTS),
        ("on", ctypes.c_int),
        ("stop", ctypes.c_int),
        ("token", ctypes.c_char * 13),
    )


def load(name: str) -> ctypes.CDLL:
    """One of the libraries that `make firmware-test` builds."""
    return ctypes.CDLL(str(BUILD / name))


@cache
def library() -> ctypes.CDLL:
    """That of a SCARA's board."""
    loaded = load("libscripted.so")
    loaded.arboleda_angle.restype = ctypes.c_size_t
    loaded.arboleda_angle.argtypes = (ctypes.c_double, ctypes.c_char_p, ctypes.c_size_t)
    text = (ctypes.c_char_p, ctypes.c_size_t)
    loaded.arboleda_decode.argtypes = (ctypes.c_int, *text, ctypes.c_int, ctypes.POINTER(Decoded))
    loaded.arboleda_stepper.restype = ctypes.c_void_p
    for name, argument in RAMP.items():
        getattr(loaded, name).argtypes = (ctypes.c_void_p, *argument)
    loaded.arboleda_step.restype = ctypes.c_int64
    return loaded


@cache
def _buffer() -> ctypes.Array[ctypes.c_char]:
    return ctypes.create_string_buffer(CAPACITY)


def _written(size: int) -> bytes:
    return _buffer().raw[:size]


def run(lines: list[str]) -> list[str]:
    """What the core's board said under a script, a line each."""
    return run_in(library().arboleda_run, lines)


def run_in(runner: Any, lines: list[str]) -> list[str]:
    """The same with a board of another library."""
    runner.restype = ctypes.c_size_t
    runner.argtypes = (ctypes.c_char_p, ctypes.c_char_p, ctypes.c_size_t)
    size = runner("\n".join(lines).encode(), _buffer(), CAPACITY)
    assert size < CAPACITY, "the board says more than this test has room for"
    return _written(size).decode().splitlines()


def angle(degrees: float) -> str:
    """An angle as the core writes it."""
    size = library().arboleda_angle(degrees, _buffer(), CAPACITY)
    return _written(size)[len('{"q":') : -1].decode()


def decode(channel: int, raw: bytes, axes: int) -> Decoded:
    """What the core makes of a message."""
    decoded = Decoded()
    library().arboleda_decode(channel, raw, len(raw), axes, ctypes.byref(decoded))
    return decoded
