"""Devices that look and answer: a camera, a scale, a barcode reader."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.kinds import Kind, kind, query


@dataclass(frozen=True, kw_only=True)
class CameraSettings:
    """Settings of a camera: its answers, and the time it takes, s; a virtual one gives the first answer."""

    answers: tuple[str | int | float, ...] = ("good", "bad")
    takes_s: float = 0.5
    at_most_s: float = 5.0


@dataclass(frozen=True, kw_only=True)
class SensorSettings:
    """Settings of a sensor: its answers, and the time it takes, s; a virtual one gives the first answer."""

    answers: tuple[str | int | float, ...] = ("present", "absent")
    takes_s: float = 0.1
    at_most_s: float = 2.0


@kind("camera")
def camera(settings: CameraSettings) -> Kind:
    """Looks at a part and says what it sees."""
    look = query(answers=settings.answers, takes_s=settings.takes_s, at_most_s=settings.at_most_s)
    return Kind(verbs={"look": look})


@kind("sensor")
def sensor(settings: SensorSettings) -> Kind:
    """Reads something and says what it is."""
    read = query(answers=settings.answers, takes_s=settings.takes_s, at_most_s=settings.at_most_s)
    return Kind(verbs={"read": read})
