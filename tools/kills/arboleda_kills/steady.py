"""The time of day as a process knew it when it began, and what has passed since: without steps of a clock."""

from __future__ import annotations

import time

from arboleda.adapters import clock

BEGAN_S = time.time() - clock.seconds()


def unix_s() -> float:
    return BEGAN_S + clock.seconds()
