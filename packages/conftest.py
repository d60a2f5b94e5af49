"""Tests of packages that move time by hand begin faults of proofs in their own process."""

from __future__ import annotations

from collections.abc import Iterator
from unittest import mock

import pytest
from tests.shared import is_real

from arboleda_proofs.campaigns.proof import forks


@pytest.fixture(autouse=True, scope="module")
def no_forks(request: pytest.FixtureRequest) -> Iterator[None]:
    """A fork would be a process beside the test."""
    with mock.patch.object(forks, "CAN_FORK", forks.CAN_FORK and is_real(request.node)):
        yield
