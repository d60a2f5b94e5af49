"""How long tests wait for what comes by itself.

It is for the busiest machine: who is answered waits no longer than that takes, only a failure takes it all.
ARBOLEDA_PATIENCE_S is another, for a machine that is slower still.
"""

import time
from collections.abc import Callable

from arboleda.testing.patience import PATIENCE_S as PATIENCE_S

PATIENCE_MS = 1000 * PATIENCE_S
LONG_S = 4 * PATIENCE_S  # a page with Python in it computes for a minute where all processors are busy
LONG_MS = 1000 * LONG_S
SOON_S = PATIENCE_S / 2  # what waits for nothing takes no longer, however busy the machine is
LOOKS_EVERY_S = 0.05


def until(condition: Callable[[], bool]) -> None:
    """Wait for what another thread or process does."""
    ends = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < ends
        time.sleep(LOOKS_EVERY_S)
