"""Guard around the messages of a device: whatever they hold, no thread of the driver ends by them."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from arboleda.drivers import plain, quoted

LOG = logging.getLogger("arboleda.drivers")
MOST = 120  # characters of a message that a sentence names


@contextmanager
def taking(item: object, lose: Callable[[str], object]) -> Iterator[None]:
    """Context in which an item is handled; after an exception it calls `lose` with a sentence."""
    try:
        yield
    except Exception as error:  # any error is blamed on the device, and reported
        LOG.debug("%s could not be taken", quoted(item, MOST), exc_info=error)
        lose(
            plain(f"it has said what cannot be taken, {quoted(item, MOST)} ({type(error).__name__}: {error})")
        )
