"""Lesson 12: an arm that is known from its URDF alone: its joints, and a task of it."""

from __future__ import annotations

from math import degrees
from pathlib import Path

from arboleda_class.lessons import spoken
from arboleda_class.notebook import World

PLANT = Path(__file__).parent / "plants" / "own_arm.yaml"


def main() -> None:
    world = World(PLANT)
    arm = world.plant(PLANT).robots["tender"]
    print("the joints of tender, from its URDF and the plant file:")
    for number, joint in enumerate(arm.joints, start=1):
        print(f"  q{number}: {degrees(joint.lower):.0f} to {degrees(joint.upper):.0f} deg")
    task = world.submit("tending 0B 2")
    world.run(until=lambda: task.ended)
    print(f"tending 0B 2: {task.state} after {world.now:.0f} s of simulated time")
    q = world.robot("tender").joints
    print("it stands at", ", ".join(f"{degrees(angle):.0f}" for angle in q), "deg")


if __name__ == "__main__":
    spoken(main)
