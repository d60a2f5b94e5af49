"""The way of a device's messages into its driver: whatever it says, no thread of the driver ends by that."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from arboleda.model.outside import plain, quoted

LOG = logging.getLogger("arboleda.drivers")
MOST = 120  # characters of a message that a sentence names


@contextmanager
def taking(said: object, lose: Callable[[str], object]) -> Iterator[None]:
    """Around what is made of a message; where that breaks, `lose` hears a sentence with the message."""
    try:
        yield
    except Exception as error:  # whatever it was, it is the device's trouble, and is told
        LOG.debug("%s could not be taken", quoted(said, MOST), exc_info=error)
        lose(
            plain(f"it has said what cannot be taken, {quoted(said, MOST)} ({type(error).__name__}: {error})")
        )
