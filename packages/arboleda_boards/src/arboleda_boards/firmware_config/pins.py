"""Pins of an ESP32 and their possible uses."""

from __future__ import annotations

from arboleda.plant_file.document import Document, Place

from .shapes import Wiring

FLASH = range(6, 12)
BOOT = (0, 2, 5, 12, 15)
INPUT_ONLY = range(34, 40)
CONSOLE = (1, 3)
MEASURING = range(32, 40)  # of the converter that Wi-Fi leaves alone
MISSING = (20, 24, 28, 29, 30, 31, 37, 38)


def check(document: Document, wiring: Wiring) -> None:
    """Keep a problem for each pin that cannot be what it is used for, and for each that is used twice."""
    names: dict[int, str] = {}
    for section in ("inputs", "outputs", "servos", "analogs"):
        for name, each in getattr(wiring, section).items():
            place = (section, name, "pin")
            if each.pin is None:
                continue
            if each.pin in names:
                document.problem(place, f"pin {each.pin} is {names[each.pin]} already")
            names[each.pin] = name
            _check_one(document, place, each.pin, section)


def _check_one(document: Document, place: Place, pin: int, section: str) -> None:
    if pin in FLASH or pin in MISSING:
        why = "belongs to the flash memory" if pin in FLASH else "is not led out"
        document.problem(place, f"pin {pin} {why}")
    elif pin in CONSOLE:
        document.problem(place, f"pin {pin} is the serial console")
    elif section in ("outputs", "servos") and pin in INPUT_ONLY:
        document.problem(place, f"pin {pin} can only be an input; outputs: 4, 13, 14, 16 to 27, 32, 33")
    elif section in ("outputs", "servos") and pin in BOOT:
        document.problem(place, f"pin {pin} is read, and may be driven, at boot; take another for an output")
    elif section == "analogs" and pin not in MEASURING:
        document.problem(place, f"pin {pin} cannot measure while Wi-Fi is on; allowed: 32 to 36, 39")
