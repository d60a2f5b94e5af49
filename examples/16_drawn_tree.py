"""Lesson 16: a tree that was drawn, not written, is a recipe like any other."""

from __future__ import annotations

from pathlib import Path

from arboleda_class.lessons import spoken
from arboleda_class.notebook import World

PLANT = Path(__file__).parent / "plants" / "workshop.yaml"


def bake(*, jammed_s: float) -> None:
    """Run the drawn recipe; the oven jams for so long from the first baking on."""
    world = World(PLANT)
    task = world.submit("bench toast shelf_2")
    world.run(until=lambda: world.robot("oven").facts["door"] == "closed")
    if jammed_s:
        world.fault("gives_up", "oven", word="atasco", seconds=jammed_s)
    world.run(until=lambda: task.ended)
    print(f"jammed for {jammed_s:g} s: {task.state} after {world.now:.0f} s")
    if task.state == "failed":
        print(f"  {task.sentence}")


def main() -> None:
    for jammed_s in (0, 5, 60):
        bake(jammed_s=jammed_s)


if __name__ == "__main__":
    spoken(main)
