"""Lesson 13: an oven that is a few lines of YAML: what it does, and how a task of it fails."""

from __future__ import annotations

from pathlib import Path

from arboleda_class.lessons import spoken
from arboleda_class.notebook import World

PLANT = Path(__file__).parent / "plants" / "workshop.yaml"


def main() -> None:
    world = World(PLANT)
    print("the oven before:", world.robot("oven").facts)
    task = world.submit("bench bake shelf_1 4")
    world.run(until=lambda: task.ended)
    print(f"{task.text}: {task.state}; the oven after:", world.robot("oven").facts)

    world = World(PLANT)
    task = world.submit("bench bake shelf_1 4")
    world.run(until=lambda: world.robot("oven").facts["door"] == "closed")
    world.fault("gives_up", "oven", word="atasco", seconds=10)
    world.run(until=lambda: task.ended)
    print(f"{task.text}: {task.state}")
    print(f"  {task.sentence}")
    print("  the oven:", world.robot("oven").facts)


if __name__ == "__main__":
    spoken(main)
