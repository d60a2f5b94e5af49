"""The plants of a day: one cell with one device, and two recipes, each of which ends with an order."""

from __future__ import annotations

from pathlib import Path

from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load

PRESS = """
name: shop
uses: [recipes.py]
kinds:
  press:
    facts: {guard: [open, closed], strokes: int}
    verbs:
      open:    {effect: motion, sets: {guard: open}, takes_s: 0.3, at_most_s: 5}
      close:   {effect: motion, sets: {guard: closed}, takes_s: 0.3, at_most_s: 5}
      press:
        {effect: process, with: {strokes: [1, 2, 3]}, sets: {strokes: $strokes}, takes_s: 0.3, at_most_s: 5}
      measure: {effect: query, answers: [good, bad], takes_s: 0.3, at_most_s: 5}
cells:
  shop:
    devices:
      press:
        kind: press
        driver:"""
PRESS_RECIPES = """
from arboleda.recipes import recipe

@recipe("work")
def close(cell):
    return cell.device("press").close()

@recipe("other")
def open_(cell):
    return cell.device("press").open()
"""
MOVER = """
name: shop
uses: [recipes.py]
cells:
  shop:
    devices:
      mover: {{{keys}, driver: {driver}}}
    targets:
      home: {{mover: {{{unit}: {home}}}}}
      a: {{mover: {{{unit}: {a}}}}}
      b: {{mover: {{{unit}: {b}}}}}
"""
MOVER_RECIPES = """
from arboleda.recipes import recipe, work

@recipe("work")
def there(cell):
    return work(cell.device("mover").go("a"), cell.device("mover").go("b"))

@recipe("other")
def back(cell):
    return work(cell.device("mover").go("b"), cell.device("mover").go("a"))
"""


def press(folder: Path, driver: str) -> PlantModel:
    """A press whose driver has these keys, further in by ten spaces."""
    return _plant(folder, PRESS + driver, PRESS_RECIPES)


def mover(folder: Path, driver: str, keys: str, unit: str, home: object, a: object, b: object) -> PlantModel:
    """A plant with a device that goes to places."""
    text = MOVER.format(keys=keys, driver=driver, unit=unit, home=home, a=a, b=b)
    return _plant(folder, text, MOVER_RECIPES)


def _plant(folder: Path, text: str, recipes: str) -> PlantModel:
    folder.mkdir()
    (folder / "recipes.py").write_text(recipes, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(text + "\n", "utf-8")
    return load(file)
