"""Python collects no garbage for a time, and goes on as it did before."""

from __future__ import annotations

import gc
from collections.abc import Callable
from contextlib import AbstractContextManager

import pytest

from arboleda.cli.loading import loading
from arboleda.host.garbage import none_collected


@pytest.mark.parametrize("time", [none_collected, loading])
def test_nothing_is_collected_for_a_time(time: Callable[[], AbstractContextManager[None]]) -> None:
    assert gc.isenabled()
    with time():
        assert not gc.isenabled()
    assert gc.isenabled()


def test_who_collects_nothing_goes_on_so() -> None:
    gc.disable()
    try:
        with none_collected():
            assert not gc.isenabled()
        assert not gc.isenabled()
    finally:
        gc.enable()
