"""Addresses and names that no PostgreSQL server has to be asked about."""

from __future__ import annotations

import pytest

from arboleda.model.errors import StartError
from arboleda_fleet.postgres.memory import PostgresMemory


@pytest.mark.parametrize(
    "address", ["postgresql://me:s3cret@127.0.0.1/x", "postgresql://me@127.0.0.1/x?password=s3cret"]
)
def test_a_password_in_the_address_is_refused_and_not_repeated(address: str) -> None:
    with pytest.raises(StartError, match="has a password in it") as refused:
        PostgresMemory(address, "plant")
    assert "s3cret" not in str(refused.value)


def test_a_name_that_would_be_cut_off_is_refused() -> None:
    with pytest.raises(StartError, match="a name of at most 57 characters"):
        PostgresMemory("postgresql://me@127.0.0.1/x", "x" * 58)
