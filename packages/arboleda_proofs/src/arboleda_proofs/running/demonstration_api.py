"""The demonstration of a plant as its page sees it."""

from __future__ import annotations

from abc import abstractmethod
from typing import Protocol


class DemonstrationApi(Protocol):
    """Demonstration: it gives tasks until somebody ends it."""

    @abstractmethod
    def end(self) -> None:
        """Give no more tasks and have nothing fail any more; from any thread."""
