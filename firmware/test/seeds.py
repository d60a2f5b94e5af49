"""Writes the golden messages as inputs of the fuzzer: a byte for channel and axes, then the message."""

from __future__ import annotations

import json
import sys
from hashlib import sha1
from pathlib import Path

VECTORS = Path(__file__).parents[2] / "wire_vectors"
CHANNELS = ("juntas", "efector", "paro", "referencia", "latido")
SIX_AXES = 130  # a multiple of the number of channels


def inputs() -> list[bytes]:
    """One per message that a board may hear."""
    names = ("messages.json", "accepted.json", "refused.json")
    rows = [row for name in names for row in json.loads((VECTORS / name).read_text(encoding="ascii"))]
    return [_input(row) for row in rows if row["channel"] in CHANNELS]


def _input(row: dict) -> bytes:
    raw = bytes.fromhex(row["hex"]) if "hex" in row else row["bytes"].encode()
    return bytes([CHANNELS.index(row["channel"]) + (SIX_AXES if row["axes"] == 6 else 0)]) + raw


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for data in inputs():
        (folder / sha1(data).hexdigest()).write_bytes(data)
