"""The OEE of a plant as the web server sees it."""

from __future__ import annotations

from abc import abstractmethod
from typing import Protocol

from arboleda.oee.figures import Oee
from arboleda.oee.rows import OeeQuery


class OeeApi(Protocol):
    """OEE of one plant."""

    @abstractmethod
    def oee(self, query: OeeQuery) -> list[Oee]:
        """The OEE of its cells, in the order of the plant file; waits for the disk."""
