"""Rows of an answer."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, TypeVar

from ..errors import LibraryMissing

Item = TypeVar("Item")


class Rows(list[Item]):
    """Rows of an answer: a list, and a table of pandas where that is installed."""

    def to_pandas(self) -> Any:
        """A DataFrame with a column for each field; times stay Unix times. LibraryMissing without pandas."""
        try:
            import pandas  # type: ignore[import-not-found, import-untyped, unused-ignore]
        except ImportError as error:
            raise LibraryMissing("pandas is not installed; type: pip install pandas") from error
        return pandas.DataFrame([asdict(row) for row in self])  # type: ignore[call-overload, unused-ignore]
