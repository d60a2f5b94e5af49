"""Bugs of the laboratory in its recipes: doors, parts, tips."""

from __future__ import annotations

from .lab_bug import (
    AFTER_READING,
    DOSED,
    FROM_NEST,
    INCUBATED,
    INTO_READER,
    OUT_OF_READER,
    PUT_INSIDE,
    SENT,
    SHELVED,
    TAKEN_OUT,
    TO_NEST,
    in_recipe,
)

OF_DOORS = (
    in_recipe(
        "The incubator is not opened before the plate goes in.",
        (INCUBATED, INCUBATED.removeprefix("        incubator.open(),\n")),
    ),
    in_recipe(
        "The incubator is not opened before the plate is taken out.",
        ("        incubator.open(),\n        taken(", "        taken("),
    ),
    in_recipe("The incubator works with its door open.", (PUT_INSIDE, '        put(cell, "inside"),\n')),
    in_recipe("The incubator stays open at the end.", (TAKEN_OUT, '        taken(cell, "inside"),\n')),
    in_recipe(
        "The arm goes into the closed reader.",
        (f"        reader.open(),\n{INTO_READER}", INTO_READER),
    ),
    in_recipe(
        "The lid closes on the arm.",
        (
            f"{INTO_READER}        reader.close(),\n",
            '        loader.visit("drawer", reader.clamp(on=True), jaw.open(), reader.close()),\n',
        ),
    ),
    in_recipe(
        "The door closes on the arm.",
        (
            PUT_INSIDE,
            '        cell.device("loader").visit("inside", cell.device("jaw").open(), incubator.close()),\n',
        ),
    ),
    in_recipe(
        "The reader stays open at the end.",
        (f"{OUT_OF_READER}        reader.close(),\n", OUT_OF_READER),
    ),
    in_recipe(
        "The reader reads with its lid open.",
        (f"{INTO_READER}        reader.close(),\n", INTO_READER),
    ),
    in_recipe(
        "Who keeps a plate that nobody can read leaves the reader open.",
        (AFTER_READING, AFTER_READING.replace("        reader.close(),\n", "")),
        ('{"clear": sent(cell), ', '{"clear": [reader.close(), sent(cell)], '),
    ),
)

OF_PARTS = (
    in_recipe("The incubator works without a plate.", (PUT_INSIDE, "        incubator.close(),\n")),
    in_recipe("The plate is left in the incubator.", (TAKEN_OUT, "        incubator.close(),\n")),
    in_recipe(
        "The plate is taken from a slot of the rack.",
        ("taken(cell, plate),\n        put", 'taken(cell, "nest"),\n        put'),
    ),
    in_recipe(
        "The plate goes back to a rack that is full.",
        ('put(cell, "nest"),\n        dosed', "put(cell, plate),\n        dosed"),
    ),
    in_recipe(
        "The plate is taken out of the wrong place.", (FROM_NEST, FROM_NEST.replace('"nest"', '"bin"'))
    ),
    in_recipe(
        "Two plates come into one nest.",
        (TO_NEST, TO_NEST + '        taken(cell, "rack_1"),\n        put(cell, "nest"),\n'),
    ),
    in_recipe(
        "The plate is not let go of in the nest.",
        ('        put(cell, "nest"),\n', '        loader.visit("nest"),\n'),
    ),
    in_recipe(
        "The plate is not let go of in the reader.",
        (INTO_READER, '        loader.visit("drawer", reader.clamp(on=True)),\n'),
    ),
    in_recipe(
        "The clamp holds the plate when it is pulled.",
        (OUT_OF_READER, '        loader.visit("drawer", jaw.close(width_mm=80, force_n=20)),\n'),
    ),
    in_recipe(
        "The clamp is opened when the arm has left with the plate.",
        (
            OUT_OF_READER,
            '        loader.visit("drawer", jaw.close(width_mm=80, force_n=20)),\n'
            "        reader.clamp(on=False),\n",
        ),
    ),
    in_recipe("The clamp is forgotten.", (INTO_READER, '        loader.visit("drawer", jaw.open()),\n')),
    in_recipe(
        "The clamp is told to hold before the plate is there.",
        (
            f"        reader.open(),\n{INTO_READER}",
            f"        reader.clamp(on=True),\n        reader.open(),\n{INTO_READER}",
        ),
    ),
    in_recipe(
        "A plate that is not clear is kept in the jaw.",
        ('[put(cell, "bin"), loader.home()]}\n    return', "[loader.home()]}\n    return"),
    ),
    in_recipe(
        "A plate that is not clear is forgotten.",
        ('"unclear": [asked, cell.choose(asked, ways)]', '"unclear": []'),
    ),
    in_recipe(
        "The task ends with the plate in the jaw.",
        ('        put(cell, "bin"),\n        loader.home(),\n', "        loader.home(),\n"),
    ),
    in_recipe(
        "The jaw closes before the arm is there.",
        (
            "return loader.visit(target, jaw.close(width_mm=80, force_n=20))",
            "return work(jaw.close(width_mm=80, force_n=20), loader.visit(target))",
        ),
    ),
    in_recipe(
        "The jaw opens before the arm is there.",
        ("return loader.visit(target, jaw.open())", "return work(jaw.open(), loader.visit(target))"),
    ),
    in_recipe(
        "Taking and putting are mixed up.", ('        put(cell, "nest"),\n', '        taken(cell, "nest"),\n')
    ),
    in_recipe("The plate is not taken from the nest.", (FROM_NEST, "        incubated(cell, minutes),\n")),
    in_recipe("The plate is left in the reader.", (OUT_OF_READER, "")),
    in_recipe(
        "The crane lets go at home.",
        (
            SHELVED,
            SHELVED.replace(
                "crane.visit(shelf, claw.open()),\n        crane.home(),",
                "crane.home(),\n        claw.open(),",
            ),
        ),
    ),
    in_recipe(
        "The crane never lets go.",
        (SHELVED, SHELVED.replace("crane.visit(shelf, claw.open())", "crane.visit(shelf)")),
    ),
    in_recipe("The plate goes onto a mover that is away.", (SENT, SENT.replace("mover.to_lab(), ", ""))),
    in_recipe(
        "The crane takes the plate from a mover that is away.",
        (SHELVED, SHELVED.replace("        mover.to_store(),\n", "")),
    ),
    in_recipe(
        "The mover is told to leave before it has the plate.",
        (SENT, 'work(mover.to_lab(), mover.to_store(), put(cell, "deck"), cell.device("loader").home())'),
    ),
)

OF_TIPS = (
    in_recipe(
        "It aspirates without a tip.",
        (DOSED, DOSED.replace('        doser.visit("tips", pipette.take_tip()),\n', "")),
    ),
    in_recipe(
        "It dispenses before it has aspirated.",
        (DOSED, DOSED.replace('        doser.visit("trough", pipette.aspirate(ul=ul)),\n', "")),
    ),
    in_recipe(
        "The tip is not ejected.",
        (DOSED, DOSED.replace('        doser.visit("waste", pipette.eject()),\n', "")),
    ),
    in_recipe(
        "The tip is ejected full.",
        (DOSED, DOSED.replace('        doser.visit("nest", pipette.dispense()),\n', "")),
    ),
    in_recipe(
        "It takes a tip twice.",
        (DOSED, DOSED.replace("pipette.take_tip()", "pipette.take_tip(), pipette.take_tip()")),
    ),
    in_recipe(
        "It ejects before it doses.",
        (
            DOSED,
            DOSED.replace("pipette.aspirate(ul=ul)", "pipette.eject()").replace(
                '"waste", pipette.eject()', '"waste", pipette.aspirate(ul=ul)'
            ),
        ),
    ),
    in_recipe(
        "The tip that is not used is not ejected.",
        ('doser.visit("waste", pipette.eject()), doser.home())', "doser.home())"),
    ),
    in_recipe(
        "The other arm goes to the trough.", ('doser.visit("trough"', 'cell.device("loader").visit("trough"')
    ),
    in_recipe("A volume that the pipette does not have.", ("ul=Choice(50, 100)", "ul=Choice(50, 1000)")),
)
RECIPE_BUGS = (*OF_DOORS, *OF_PARTS, *OF_TIPS)
