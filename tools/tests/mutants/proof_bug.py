"""Bug for `prove`: a mistake that people make in the recipes or the plant file of an example."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

RECIPES, PLANT = "recipes.py", "plant.yaml"
HERE, EXAMPLES = Path(__file__).parent, Path(__file__).parents[3] / "examples"
PLANTS = {
    **{each: EXAMPLES / each for each in ("lab_bench", "assembly", "kitting", "machine_tending")},
    **{each: HERE / each for each in ("lab", "rail")},
}


@dataclass(frozen=True, kw_only=True)
class ProofBug:
    """A bug of a plant: in its files, text that stands there once becomes another one."""

    plant: str
    about: str
    edits: tuple[tuple[str, str, str], ...]  # file, what stands there, what stands there then

    def edited(self, files: dict[str, str]) -> dict[str, str]:
        """The files with the bug."""
        for file, old, new in self.edits:
            assert files[file].count(old) == 1, f"{self.about}: {file} holds this not once: {old}"
            files = files | {file: files[file].replace(old, new)}
        return files


def in_recipe(plant: str, about: str, *edits: tuple[str, str]) -> ProofBug:
    return ProofBug(plant=plant, about=about, edits=tuple((RECIPES, *each) for each in edits))


def in_plant(plant: str, about: str, *edits: tuple[str, str]) -> ProofBug:
    return ProofBug(plant=plant, about=about, edits=tuple((PLANT, *each) for each in edits))
