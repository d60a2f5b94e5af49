"""Bugs of cells whose arms meet in a machine: the assembly station and the mill."""

from __future__ import annotations

from functools import partial

from . import proof_bug

recipe, plant = partial(proof_bug.in_recipe, "assembly"), partial(proof_bug.in_plant, "assembly")
OUT = 'left.visit("nest", left.grip(), fixture.clamp(on=False))'
IN = 'left.visit("nest", left.let_go(), fixture.clamp(on=True))'
OF_THE_STATION = (
    recipe(
        "The ram stays down.",
        ("        fixture.press(),\n        fixture.lift(),\n", "        fixture.press(),\n"),
    ),
    recipe(
        "It presses what is not clamped.",
        (IN, 'left.visit("nest", left.let_go())'),
    ),
    recipe(
        "It is clamped before it is there.", (IN, 'fixture.clamp(on=True), left.visit("nest", left.let_go())')
    ),
    recipe("The clamp holds when the part is pulled.", (OUT, 'left.visit("nest", left.grip())')),
    recipe(
        "The clamp opens when the arm has left with the part.",
        (OUT, 'left.visit("nest", left.grip()), fixture.clamp(on=False)'),
    ),
    recipe(
        "The ram comes down on the arm.",
        (
            'right.visit("seat", right.let_go()),\n        fixture.press(),',
            'right.visit("seat", right.let_go(), fixture.press()),',
        ),
    ),
    recipe("The lid is not gripped.", ("right.visit(lid, right.grip())", "right.visit(lid)")),
    recipe("The lid is not let go of.", ('right.visit("seat", right.let_go())', 'right.visit("seat")')),
    recipe("The base is not let go of.", (IN, 'left.visit("nest", fixture.clamp(on=True))')),
    recipe("The finished part is not gripped.", (OUT, 'left.visit("nest", fixture.clamp(on=False))')),
    recipe("The finished part is not put down.", ('left.visit("done", left.let_go())', 'left.visit("done")')),
    recipe("The wrong arm.", ("right.visit(lid, right.grip())", "left.visit(lid, left.grip())")),
    recipe(
        "One arm does two things at once.",
        (
            'parallel(left.visit("done", left.let_go()), right.home())',
            'parallel(left.visit("done", left.let_go()), left.home())',
        ),
    ),
    recipe("The left arm stays where it was.", ("        left.home(),\n", "")),
    plant(
        "The zone over the nest is forgotten.",
        (
            "zones:\n"
            "  over_the_nest: {poses: [station nest, station seat], free_while: {fixture: {ram: up}}}\n",
            "",
        ),
    ),
    plant("The ram keeps nobody out.", (", free_while: {fixture: {ram: up}}", "")),
    plant("The zone is free while the ram is down.", ("{fixture: {ram: up}}", "{fixture: {ram: down}}")),
    plant("Pressing needs an open clamp.", ("needs: {clamped: true}", "needs: {clamped: false}")),
    plant("Lifting the ram puts it down.", ("sets: {ram: up}", "sets: {ram: down}")),
)

recipe, plant = (
    partial(proof_bug.in_recipe, "machine_tending"),
    partial(proof_bug.in_plant, "machine_tending"),
)
OUT = 'tender.visit("vise", tender.grip(), mill.clamp(on=False))'
IN = 'loader.visit("vise", mill.clamp(on=True), jaw.open())'
RUN = "        mill.close(),\n        mill.run(program=program),\n        mill.open(),\n"
OF_THE_MILL = (
    recipe("It mills with its door open.", (RUN, "        mill.run(program=program),\n")),
    recipe("The door stays closed.", (RUN, RUN.replace("        mill.open(),\n", ""))),
    recipe("It mills what is not clamped.", (IN, 'loader.visit("vise", jaw.open())')),
    recipe(
        "The jaw opens before the clamp holds.", (IN, 'loader.visit("vise", jaw.open(), mill.clamp(on=True))')
    ),
    recipe("The door closes on the loader.", (IN + ",\n        mill.close(),", IN[:-1] + ", mill.close()),")),
    recipe("The clamp holds when the part is pulled.", (OUT, 'tender.visit("vise", tender.grip())')),
    recipe(
        "The clamp opens before anybody grips.",
        (OUT, 'tender.visit("vise", mill.clamp(on=False), tender.grip())'),
    ),
    recipe("The jaw never opens.", (IN, 'loader.visit("vise", mill.clamp(on=True))')),
    recipe(
        "The jaw does not close.",
        ("loader.visit(blank, jaw.close(width_mm=30, force_n=40))", "loader.visit(blank)"),
    ),
    recipe(
        "The tender keeps a bad part.",
        ('[tender.visit("reject", tender.let_go()), tender.home()]', "[tender.home()]"),
    ),
    recipe(
        "The good part is not put down.", ('tender.visit("belt", tender.let_go())', 'tender.visit("belt")')
    ),
    recipe("Good and bad are mixed up.", ('{"good": good, "bad": bad}', '{"good": good, "fair": bad}')),
    recipe("Nobody asks where the camera is unsure.", ('"unsure": unsure', '"unclear": unsure')),
    recipe(
        "Nobody has answered what it goes on by.",
        ("[asked, cell.choose(asked, sorting(cell))]", "cell.choose(asked, sorting(cell))"),
    ),
    recipe("The jaw takes more than it may.", ("force_n=40", "force_n=400")),
    recipe("Nobody looks whether the belt is clear.", ('        belt.says(entry="clear"),\n', "")),
    recipe("The belt is never told to clear.", ('        belt.clear("entry"),\n', "")),
    recipe("The same blank again and again.", ('blank=f"slot_{slot}"', 'blank=f"slot_{slot + 1}"')),
    plant(
        "The zone in the mill is forgotten.",
        ("zones:\n  inside_the_mill: {poses: [tending vise], free_while: {mill: {door: open}}}\n", ""),
    ),
    plant("The door keeps nobody out.", (", free_while: {mill: {door: open}}", "")),
    plant(
        "The mill runs with its door open.",
        ("needs: {door: closed, clamped: true}", "needs: {door: open, clamped: true}"),
    ),
    plant("The mill has less time than it takes.", ("at_most_s: 90", "at_most_s: 9")),
    plant("The jaw is nobody's tool.", ("tool_of: loader, max", "max")),
)
BUGS_OF_ARMS = (*OF_THE_STATION, *OF_THE_MILL)
