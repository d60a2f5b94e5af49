"""Id of a goal: a UUID that tells a later start of the plant which command of which device it is of.

Of version 8 of RFC 9562, whose bits are the application's own: what is made of a hash, as version 5 is, could
not be read back, and a server that still lists a goal would prove nothing of it.
"""

from __future__ import annotations

import re
from hashlib import blake2b
from typing import NamedTuple

VERSION, VARIANT = 8, 0b10
DEVICE_BITS, EPOCH_BITS, NUMBER_BITS = 20, 32, 20
_TOKEN = re.compile(r"[0-9a-f]{12}", re.ASCII)


class GoalId(NamedTuple):
    """Command of a device as the id of its goal: `number` counts the commands of the device since the start
    `epoch` of the plant, and `is_last` is True for the goal that ends it, as a command may have several.
    `token` is the command's, 12 hexadecimal characters, or None.
    """

    device: int
    epoch: int
    number: int
    is_last: bool
    token: str | None = None

    @property
    def uuid(self) -> bytes:
        """The 16 bytes as RFC 9562 orders them: the token, a part of the device's hash, then the rest."""
        token = int(self.token, 16) if self.token and _TOKEN.fullmatch(self.token) else None
        rest = self.device & 0xFF
        for value, bits in (
            (self.epoch, EPOCH_BITS),
            (self.number, NUMBER_BITS),
            (self.is_last, 1),
            (token is not None, 1),
        ):
            rest = rest << bits | int(value) & (1 << bits) - 1
        head = (token or 0) << 16 | VERSION << 12 | self.device >> 8
        return (head << 64 | VARIANT << 62 | rest).to_bytes(16, "big")

    @classmethod
    def read(cls, uuid: bytes) -> GoalId | None:
        """The command that the id of a goal names; None for one that no plant made."""
        whole = int.from_bytes(uuid, "big")
        head, rest = whole >> 64, whole & (1 << 62) - 1
        if len(uuid) != 16 or head >> 12 & 0xF != VERSION or whole >> 62 & 0b11 != VARIANT:
            return None
        return cls(
            device=(head & 0xFFF) << 8 | rest >> 54,
            epoch=rest >> 22 & (1 << EPOCH_BITS) - 1,
            number=rest >> 2 & (1 << NUMBER_BITS) - 1,
            is_last=bool(rest & 2),
            token=f"{head >> 16:012x}" if rest & 1 else None,
        )


def hash_of(device: str) -> int:
    """The hash of a device's name, of DEVICE_BITS."""
    return int.from_bytes(blake2b(device.encode(), digest_size=4).digest(), "big") >> 32 - DEVICE_BITS
