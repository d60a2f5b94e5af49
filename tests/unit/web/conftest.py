"""The application of a plant behind its guard, asked in this process."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest

from ...guarded_plant import Web, guarded
from ...in_process import Caller, without_threads
from ...web_plant import TOKENS, Plant


@pytest.fixture(autouse=True)
def no_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    without_threads(monkeypatch)


@pytest.fixture
def plant() -> Plant:
    return Plant()


@pytest.fixture
def serve(plant: Plant) -> Callable[..., Web]:
    """`serve()`, `serve(tokens)`: see `guarded`."""
    return partial(guarded, plant)


@pytest.fixture
def local(serve: Callable[..., Web]) -> Web:
    """A plant on one's own machine."""
    return serve()


@pytest.fixture
def open_to_all(serve: Callable[..., Web]) -> Web:
    """A plant on a network."""
    return serve(dict(TOKENS))


@pytest.fixture
def web(local: Web) -> Caller:
    return local.client()
