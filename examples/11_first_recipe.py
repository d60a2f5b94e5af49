"""Lesson 11: a recipe of one's own carries a part; what the task did, and where the part is now."""

from __future__ import annotations

from pathlib import Path

from arboleda_class.lessons import spoken
from arboleda_class.notebook import World

PLANT = Path(__file__).parent / "plants" / "workshop.yaml"


def do(world: World, text: str) -> None:
    """Ask for a task, and print each of its steps and its end."""
    print(f"submit {text!r}")
    task = world.submit(text)
    world.run(until=lambda: task.ended)
    for row in world.table():
        if row.kind == "task":
            print(f"  {row.at:5.1f} s  {row.what}: {row.sentence.partition(' #')[0]}")
        if row.kind == "step":
            print(f"  {row.at:5.1f} s  {row.sentence}")
    if task.state == "refused":
        print(f"  refused: {task.sentence}")
    print(f"  so the task is {task.state}")


def main() -> None:
    do(World(PLANT), "bench carry shelf_2")
    do(World(PLANT), "bench carry shelf_9")


if __name__ == "__main__":
    spoken(main)
