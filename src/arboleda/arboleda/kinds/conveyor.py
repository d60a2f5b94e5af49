"""A conveyor with sensors along it: it runs until one of them sees a part, or sees none any more."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.kinds import Kind, KindError, kind, motion

CLEAR, TAKEN = "clear", "taken"


@dataclass(frozen=True, kw_only=True)
class ConveyorSettings:
    """Settings of a conveyor: its sensors in the order of passing parts, and the time between two, s."""

    sensors: tuple[str, ...] = ("entry", "exit")
    takes_s: float = 3.0
    at_most_s: float = 15.0

    def __post_init__(self) -> None:
        if not self.sensors or len(set(self.sensors)) < len(self.sensors):
            raise KindError("sensors must have at least 1 name, and none of them twice")


@kind("conveyor")
def conveyor(settings: ConveyorSettings) -> Kind:
    """Runs until one of its sensors sees a part, or sees none any more."""
    names = settings.sensors

    def passed(facts: dict[str, object], to: str) -> dict[str, str]:
        """The sensors when a part stands at one of them: it has left those before it."""
        return dict.fromkeys(names[: names.index(to)], CLEAR)

    return Kind(
        facts={name: [CLEAR, TAKEN] for name in names},
        verbs={
            "advance": motion(
                parameters={"to": list(names)},
                sets=lambda to: {to: TAKEN},
                virtual=passed,
                takes_s=settings.takes_s,
                at_most_s=settings.at_most_s,
            ),
            "clear": motion(
                parameters={"at": list(names)},
                sets=lambda at: {at: CLEAR},
                takes_s=settings.takes_s,
                at_most_s=settings.at_most_s,
            ),
        },
    )
