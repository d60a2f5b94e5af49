"""Bugs of the two plants that are written for them: the laboratory, and two cells at one rail."""

from __future__ import annotations

from functools import partial

from . import proof_bug
from .lab_bugs import LAB_BUGS

OF_THE_LAB = tuple(proof_bug.ProofBug(plant="lab", about=each.about, edits=each.edits) for each in LAB_BUGS)[
    ::5
]

recipe, plant = partial(proof_bug.in_recipe, "rail"), partial(proof_bug.in_plant, "rail")
DRIVEN = """        changer.take_driver(),
        [changer.drive() for _ in range(screws)],
        changer.put_back(),
"""
SWEPT = """        changer.take_brush(),
        changer.sweep(),
        changer.put_back(),
"""
TAKEN_OUT = """        oven.open(),
        arm.visit("inside", jaw.close(width_mm=40, force_n=20)),
"""
OF_THE_RAIL = (
    recipe(
        "The driver is used without being picked up.",
        (DRIVEN, DRIVEN.replace("        changer.take_driver(),\n", "")),
    ),
    recipe(
        "The brush is used without being picked up.",
        (SWEPT, SWEPT.replace("        changer.take_brush(),\n", "")),
    ),
    recipe("The wrong tool is picked up.", ("changer.take_driver()", "changer.take_brush()")),
    recipe("The driver is not put back.", (DRIVEN, DRIVEN.replace("        changer.put_back(),\n", ""))),
    recipe("The brush is not put back.", (SWEPT, SWEPT.replace("        changer.put_back(),\n", ""))),
    recipe("The part is forgotten in the closed oven.", (TAKEN_OUT, "        oven.open(),\n")),
    recipe(
        "The arm reaches into the closed oven.", (TAKEN_OUT, TAKEN_OUT.replace("        oven.open(),\n", ""))
    ),
    recipe(
        "The oven bakes with its door open.",
        ("        oven.close(),\n        oven.bake(),\n", "        oven.bake(),\n"),
    ),
    recipe("The oven bakes nothing.", ('        arm.visit("inside", jaw.open()),\n', "")),
    recipe("The oven stays open.", ("        oven.close(),\n        carriage", "        carriage")),
    recipe(
        "The carriage leaves with the arm over it.",
        (
            'arm.visit("deck", jaw.open()),\n        arm.home(),',
            'arm.visit("deck", jaw.open(), carriage.to_south()),\n        arm.home(),',
        ),
    ),
    recipe(
        "The carriage leaves while the jaw holds.",
        ('        arm.visit("deck", jaw.open()),\n', '        arm.visit("deck"),\n'),
    ),
    recipe("The carriage is not called.", ("        carriage.to_north(),\n", "")),
    recipe("The carriage is called to the wrong side.", ("carriage.to_north()", "carriage.to_south()")),
    recipe(
        "The carriage is not sent.",
        ("        oven.close(),\n        carriage.to_south(),\n", "        oven.close(),\n"),
    ),
    recipe(
        "The part is put back on the carriage.",
        ('arm.visit("box", claw.open())', 'arm.visit("deck", claw.open())'),
    ),
    recipe("The claw stays closed.", ('arm.visit("box", claw.open())', 'arm.visit("box")')),
    recipe("It is weighed for ever.", ("times=2, pause_s=1", "times=100_000, pause_s=1")),
    recipe(
        "Nobody looks whether the part is heavy enough.",
        ("        cell.retry(weight, times=2, pause_s=1),\n", ""),
    ),
    recipe(
        "The brush sweeps while the arm works.",
        (SWEPT, ""),
        (
            "        cell.retry(weight, times=2, pause_s=1),\n",
            SWEPT + "        cell.retry(weight, times=2, pause_s=1),\n        [changer.drive()],\n",
        ),
    ),
    recipe(
        "A failure is brought back to the oven.",
        ('arm.brings_back_to("box")', 'arm.brings_back_to("inside")'),
    ),
    recipe(
        "What the oven says does not matter.",
        ("        oven.bake(),\n", "        cell.fallback(oven.bake(), cell.wait(1)),\n"),
    ),
    recipe(
        "What the driver says does not matter.",
        (
            "[changer.drive() for _ in range(screws)]",
            "[cell.fallback(changer.drive(), cell.wait(0.1)) for _ in range(screws)]",
        ),
    ),
    plant(
        "Each cell has the rail for itself.",
        ("shared:\n  carriage: {kind: carriage}\n", ""),
        (
            "      carriage: {shared: carriage}\n    targets:\n      home:   ",
            "      carriage: {kind: carriage}\n    targets:\n      home:   ",
        ),
        (
            "      carriage: {shared: carriage}\n    targets:\n      home: {",
            "      carriage: {kind: carriage, name: other_carriage, mqtt: other_carriage}\n"
            "    targets:\n      home: {",
        ),
    ),
    plant(
        "The zone at the north is forgotten.",
        ("  at_the_north: {poses: [north deck], free_while: {carriage: {at: north}}}\n", ""),
    ),
    plant(
        "The zone at the south is free while the carriage is in the north.",
        (
            "{poses: [south deck], free_while: {carriage: {at: south}}}",
            "{poses: [south deck], free_while: {carriage: {at: north}}}",
        ),
    ),
    plant(
        "The zone in the oven is forgotten.",
        ("  in_the_oven:  {poses: [north inside], free_while: {oven: {door: open}}}\n", ""),
    ),
    plant(
        "The carriage may leave while the jaw holds.",
        ("    needs:\n      carriage.to_south: {jaw.gripped: false}\n", ""),
    ),
    plant(
        "The driver drives without a tool.",
        (
            "drive:       {effect: process, needs: {tool: driver}, takes_s: 2}",
            "drive:       {effect: process, needs: {tool: none}, takes_s: 2}",
        ),
    ),
    plant("The oven has less time than it takes.", ("at_most_s: 20", "at_most_s: 2")),
)
BUGS_OF_LABS = (*OF_THE_LAB, *OF_THE_RAIL)
