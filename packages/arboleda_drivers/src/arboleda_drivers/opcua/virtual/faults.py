"""Faults of the virtual PLC of OPC UA."""

from __future__ import annotations

from arboleda_drivers.plc.virtual.machine import FAULTS as BELT_FAULTS

FAULTS = {
    "mute": "requests are not answered, and connections stay",
    "refuses_calls": "every method returns BadUserAccessDenied",
    "bad_status": "the place of the part has the status BadSensorFailure",
    "null": "the place of the part is null",
    "text": "the place of the part is text where a number should be",
    **BELT_FAULTS,
}
