"""Writes the golden messages as inputs of the fuzzers: a byte for channel and axes, then the message; with
`--orders` those of the press of examples/press_board, as they are."""

from __future__ import annotations

import json
import sys
from hashlib import sha1
from pathlib import Path
from typing import Any

VECTORS = Path(__file__).parents[2] / "wire_vectors"
CHANNELS = ("juntas", "efector", "paro", "referencia", "latido")
SIX_AXES = 130  # a multiple of the number of channels


ORDERS = (
    b'{"verbo":"open","seq":2,"epoca":1}',
    b'{"verbo":"open","seq":2,"epoca":1,"visto":2}',
    b'{"verbo":"clamp","valores":{"on":false},"seq":2,"epoca":1}',
    b'{"verbo":"press","valores":{"program":2},"seq":2,"epoca":1}',
    b'{"verbo":"look","seq":1,"epoca":2,"valores":{}}',
)


def orders() -> list[bytes]:
    """Those of the press, and the golden ones of any device."""
    names = ("messages.json", "accepted.json", "refused.json")
    rows = [row for name in names for row in json.loads((VECTORS / name).read_text(encoding="ascii"))]
    return [*ORDERS, *(_raw(row) for row in rows if row["channel"] == "orden")]


def inputs() -> list[bytes]:
    """One per message that a board may hear."""
    names = ("messages.json", "accepted.json", "refused.json")
    rows = [row for name in names for row in json.loads((VECTORS / name).read_text(encoding="ascii"))]
    return [_input(row) for row in rows if row["channel"] in CHANNELS]


def _input(row: dict[str, Any]) -> bytes:
    return bytes([CHANNELS.index(row["channel"]) + (SIX_AXES if row["axes"] == 6 else 0)]) + _raw(row)


def _raw(row: dict[str, Any]) -> bytes:
    return bytes.fromhex(row["hex"]) if "hex" in row else row["bytes"].encode()


if __name__ == "__main__":
    folder = Path(sys.argv[-1])
    for data in orders() if "--orders" in sys.argv else inputs():
        (folder / sha1(data).hexdigest()).write_bytes(data)
