"""Checks of a wiring by itself: pins, limits, numbers of parts."""

from __future__ import annotations

from arboleda.drivers import Device, Evidence
from arboleda.plant_file.document import Document

from . import pins
from .naming import unknown
from .shapes import InputShape, Wiring

MOST = {"inputs": 16, "outputs": 16, "servos": 4, "analogs": 4}
MOST_FACTS = 16


def check(document: Document, device: Device, wiring: Wiring) -> None:
    """Keep a problem for each mistake of the wiring."""
    pins.check(document, wiring)
    _check_room(document, device, wiring)
    for name, each in wiring.inputs.items():
        if (sentence := _input_objection(each)) is not None:
            document.problem(("inputs", name), sentence)
        if each.analog is not None and each.analog not in wiring.analogs:
            unknown(document, ("inputs", name, "analog"), each.analog, wiring.analogs, "analog input")
    for name, servo in wiring.servos.items():
        if servo.degrees[0] >= servo.degrees[1] or servo.pulse_us[0] == servo.pulse_us[1]:
            document.problem(("servos", name), "degrees go from less to more, pulses to another")
    for name, analog in wiring.analogs.items():
        if analog.counts[0] == analog.counts[1] or analog.broken[0] >= analog.broken[1]:
            document.problem(("analogs", name), "counts must be two, and broken go from less to more")


def _check_room(document: Document, device: Device, wiring: Wiring) -> None:
    if device.evidence is not Evidence.IDS:
        document.problem((), f"{device.name} has evidence: {device.evidence.value}; this board has ids")
    for section, most in MOST.items():
        if len(getattr(wiring, section)) > most:
            document.problem((section,), f"a board has room for {most}")
    if len(device.kind.facts) > MOST_FACTS:
        document.problem(("facts",), f"a board has room for {MOST_FACTS}")


def _input_objection(each: InputShape) -> str | None:
    above, below = each.on_above, each.off_below
    if (each.pin is None) == (each.analog is None):
        return "needs a pin, or an analog input that it compares"
    if each.analog is None:
        compares = above is not None or below is not None
        return "on_above and off_below are for one that compares an analog input" if compares else None
    sensible = above is not None and below is not None and below <= above
    return None if sensible else "needs on_above and off_below, which is not above that"
