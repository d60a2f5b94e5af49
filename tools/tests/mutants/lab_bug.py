"""Bug of the laboratory: a mistake that people make in recipes and plant files, as a small edit."""

from __future__ import annotations

from dataclasses import dataclass

RECIPES, PLANT = "recipes.py", "plant.yaml"


@dataclass(frozen=True, kw_only=True)
class LabBug:
    """A bug: in files of the laboratory, text that stands there once becomes another one."""

    about: str
    edits: tuple[tuple[str, str, str], ...]  # file, what stands there, what stands there then

    def edited(self, files: dict[str, str]) -> dict[str, str]:
        """The files with the bug."""
        for file, old, new in self.edits:
            assert files[file].count(old) == 1, f"{file} holds this not once: {old}"
            files = files | {file: files[file].replace(old, new)}
        return files


def in_recipe(about: str, *edits: tuple[str, str]) -> LabBug:
    return LabBug(about=about, edits=tuple((RECIPES, *each) for each in edits))


def in_plant(about: str, *edits: tuple[str, str]) -> LabBug:
    return LabBug(about=about, edits=tuple((PLANT, *each) for each in edits))


INCUBATED = """        incubator.open(),
        put(cell, "inside"),
        incubator.close(),
        incubator.incubate(minutes=minutes),
        incubator.open(),
        taken(cell, "inside"),
        incubator.close(),
"""
PUT_INSIDE = """        put(cell, "inside"),
        incubator.close(),
"""
TAKEN_OUT = """        taken(cell, "inside"),
        incubator.close(),
"""
INTO_READER = """        loader.visit("drawer", reader.clamp(on=True), jaw.open()),
"""
OUT_OF_READER = """        loader.visit("drawer", jaw.close(width_mm=80, force_n=20), reader.clamp(on=False)),
"""
AFTER_READING = f"""        cell.retry(seen, times=2, pause_s=1),
        reader.open(),
{OUT_OF_READER}        reader.close(),
"""
DOSED = """        doser.visit("tips", pipette.take_tip()),
        doser.visit("trough", pipette.aspirate(ul=ul)),
        doser.visit("nest", pipette.dispense()),
        doser.visit("waste", pipette.eject()),
        doser.home(),
"""
TO_NEST = """        taken(cell, plate),
        put(cell, "nest"),
"""
FROM_NEST = """        taken(cell, "nest"),
        incubated(cell, minutes),
"""
SENT = 'work(mover.to_lab(), put(cell, "deck"), cell.device("loader").home(), mover.to_store())'
SHELVED = """        mover.to_store(),
        crane.visit("deck", claw.close(width_mm=80, force_n=20)),
        crane.visit(shelf, claw.open()),
        crane.home(),
"""
