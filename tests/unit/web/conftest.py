"""The application of a plant behind its guard, asked in this process."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest
from tests.guarded_plant import Web, guarded
from tests.in_process import without_threads
from tests.web_plant import Plant
from tests.web_plant import local as local
from tests.web_plant import open_to_all as open_to_all
from tests.web_plant import plant as plant
from tests.web_plant import web as web


@pytest.fixture(autouse=True)
def no_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    without_threads(monkeypatch)


@pytest.fixture
def serve(plant: Plant) -> Callable[..., Web]:
    """`serve()`, `serve(tokens)`: see `guarded`."""
    return partial(guarded, plant)
