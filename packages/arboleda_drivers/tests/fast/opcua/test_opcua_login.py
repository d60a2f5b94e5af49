"""Logins at a PLC that cannot work, said before anything is begun."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.drivers.port import DriverError
from arboleda_drivers.opcua.adapter import OpcUa
from arboleda_drivers.opcua.settings import Settings

from ..plc.plcs import PLCS


@pytest.mark.requires("asyncua")
@pytest.mark.parametrize(
    ("security", "variables", "why"),
    [
        ("none", {"PLC_USER": "cell"}, "security: none would send its password readable"),
        ("sign", {}, "security: sign needs a file in PLC_CERT; it is not set"),
        ("sign", {"PLC_CERT": "/nowhere.pem"}, "/nowhere.pem is no file"),
    ],
)
def test_a_login_that_cannot_work_is_said(
    monkeypatch: pytest.MonkeyPatch, security: Any, variables: dict[str, str], why: str
) -> None:
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    belt = PLCS["opcua"].device
    assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
    driver = OpcUa(replace(belt.driver.settings, security=security, secrets="PLC"))
    with pytest.raises(DriverError, match=why):
        driver.start([belt], lambda report: None, lambda: 0.0)
    driver.stop()
