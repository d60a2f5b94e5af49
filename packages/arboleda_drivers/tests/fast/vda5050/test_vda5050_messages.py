"""Messages of VDA 5050 as vehicles write them."""

from __future__ import annotations

import json
from typing import Any

import pytest

from arboleda_drivers.vda5050.messages import Headers, SchemaMismatch, from_bytes
from arboleda_drivers.vda5050.virtual.machine import VirtualAgv
from arboleda_drivers.vda5050.virtual.words import state_of

VERSIONS = ("2.0", "2.1", "3.0")


def told(version: str, **news: Any) -> dict[str, Any]:
    """A state with changes, as a driver reads it."""
    headers = Headers(version, "arboleda", "agv1")
    said = {**headers("state"), **state_of(VirtualAgv(version=version), (), version), **news}
    return from_bytes(version, "state", json.dumps(said).encode())


@pytest.mark.parametrize("version", VERSIONS)
def test_a_number_without_a_fraction_is_a_whole_one(version: str) -> None:
    said = told(version, lastNodeSequenceId=2.0, headerId=7.0)
    found = (said["lastNodeSequenceId"], said["headerId"])
    assert found == (2, 7) and all(isinstance(each, int) for each in found)


@pytest.mark.parametrize("version", VERSIONS)
def test_an_optional_field_that_is_null_is_not_there(version: str) -> None:
    error = {"errorType": "drive", "errorLevel": "WARNING", "errorDescription": None, "errorReferences": None}
    said = told(version, distanceSinceLastNode=None, zoneSetId=None, errors=[error])
    assert "distanceSinceLastNode" not in said and "zoneSetId" not in said
    assert said["errors"] == [{"errorType": "drive", "errorLevel": "WARNING"}]


def test_a_field_that_has_to_be_there_is_not_null() -> None:
    with pytest.raises(SchemaMismatch, match="orderId"):
        told("2.1", orderId=None)


def test_what_does_not_fit_is_named_with_its_value() -> None:
    with pytest.raises(SchemaMismatch) as refused:
        told("2.1", lastNodeSequenceId="two")
    assert str(refused.value) == "lastNodeSequenceId must be integer; it is 'two'"
