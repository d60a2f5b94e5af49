"""Bugs of the laboratory in its recipes: steps around steps, and habits."""

from __future__ import annotations

from .lab_bug import DOSED, INTO_READER, SENT, TAKEN_OUT, in_recipe

OF_STEPS = (
    in_recipe("It is tried again without a limit.", ("times=2, pause_s=1", "times=100_000, pause_s=1")),
    in_recipe("It is tried again for hours.", ("times=2, pause_s=1", "times=60, pause_s=600")),
    in_recipe(
        "An answer has no way.",
        ('{"clear": sent(cell), "unclear": [asked, cell.choose(asked, ways)]}', '{"clear": sent(cell)}'),
    ),
    in_recipe("An answer that there is not has a way.", ('"unclear": [asked', '"unclean": [asked')),
    in_recipe(
        "It goes on by an answer that nobody has been asked for.",
        ("        cell.retry(seen, times=2, pause_s=1),\n", ""),
    ),
    in_recipe(
        "It goes on by the answer to a question that is not asked.",
        ("[asked, cell.choose(asked, ways)]", "cell.choose(asked, ways)"),
    ),
    in_recipe(
        "A step stands at two places.",
        ('ways = {"yes": sent(cell), ', 'away = sent(cell)\n    ways = {"yes": away, '),
        ('"clear": sent(cell), ', '"clear": away, '),
    ),
    in_recipe(
        "The parentheses of a step are forgotten.",
        (
            "        parallel(incubated(cell, minutes), fresh),",
            "        parallel(incubated(cell, minutes), fresh), cell.device('reader').close,",
        ),
    ),
    in_recipe(
        "A role is misspelt.", ('"loader", "jaw", "reader", "ana")', '"loader", "jaw", "raeder", "ana")')
    ),
    in_recipe("A target is misspelt.", ('put(cell, "deck"), cell', 'put(cell, "desk"), cell')),
    in_recipe(
        "It is given too little time.",
        (
            "        cell.retry(seen, times=2, pause_s=1),",
            "        cell.timeout(cell.retry(seen, times=2, pause_s=1), 2),",
        ),
    ),
    in_recipe(
        "It waits for what never comes.",
        (
            f"{INTO_READER}        reader.close(),\n",
            f'{INTO_READER}        reader.close(),\n        reader.becomes(lid="open", at_most_s=5),\n',
        ),
    ),
    in_recipe(
        "It checks the opposite.",
        (
            f"{INTO_READER}        reader.close(),\n",
            f"{INTO_READER}        reader.close(),\n        reader.says(clamped=False),\n",
        ),
    ),
    in_recipe(
        "A failure is taken for an alternative, and the task is done.",
        ("        cell.retry(seen, times=2, pause_s=1),\n", "        seen,\n"),
        (
            "    return work(\n        taken(cell, plate),\n        parallel",
            "    return work(\n        taken(cell, plate),\n"
            "        cell.fallback(cell.device('reader').clamp(on=True), cell.wait(1)),\n        parallel",
        ),
    ),
    in_recipe(
        "Two devices at once are one.",
        (
            "parallel(incubated(cell, minutes), fresh)",
            'parallel(incubated(cell, minutes), put(cell, "bin"), fresh)',
        ),
    ),
    in_recipe(
        "The step is made and never done.",
        ("        dosed(cell, ul),\n", ""),
        (
            '    loader.brings_back_to("bin")\n    seen',
            '    loader.brings_back_to("bin")\n    dosed(cell, ul)\n    seen',
        ),
    ),
    in_recipe(
        "The mover is used outside of using.",
        (
            SENT,
            'work(cell.using("mover", mover.to_lab(), put(cell, "deck"), cell.device("loader").home()), '
            "mover.to_store())",
        ),
    ),
    in_recipe(
        "A recipe runs itself.",
        (
            "        incubated(cell, minutes),\n        reader",
            "        incubated(cell, minutes),\n"
            "        cell.run(warm_up, plate=plate, minutes=minutes),\n        reader",
        ),
        (
            "        parallel(incubated(cell, minutes), fresh),\n",
            "        parallel(incubated(cell, minutes), fresh),\n"
            "        cell.run(warm_up, plate=plate, minutes=minutes),\n",
        ),
    ),
)

OF_HABITS = (
    in_recipe(
        "The arm is not sent home from the bin.",
        ('"no": [put(cell, "bin"), loader.home()]', '"no": put(cell, "bin")'),
    ),
    in_recipe("The doser stays over the waste.", (DOSED, DOSED.replace("        doser.home(),\n", ""))),
    in_recipe(
        "The other way keeps the reader open.",
        ('"yes": sent(cell), "no": [put', '"yes": sent(cell), "no": [reader.open(), put'),
    ),
    in_recipe(
        "The door is opened twice and never closed.",
        (TAKEN_OUT, TAKEN_OUT.replace("incubator.close()", "incubator.open()")),
    ),
    in_recipe(
        "A tip is taken once for many plates, and thrown away each time.",
        (
            "        dosed(cell, ul),\n",
            "        cell.device('doser').visit('waste', cell.device('pipette').eject()),\n"
            "        dosed(cell, ul),\n",
        ),
    ),
    in_recipe(
        "It doses again with a tip that it has thrown away.",
        (
            "        dosed(cell, ul),\n",
            "        dosed(cell, ul),\n        cell.device('pipette').aspirate(ul=ul),\n",
        ),
    ),
    in_recipe(
        "What is let go of in the reader is clamped afterwards.",
        (
            INTO_READER,
            '        loader.visit("drawer", jaw.open()),\n        reader.close(),\n        reader.open(),\n'
            "        reader.clamp(on=True),\n"
            '        loader.visit("drawer", jaw.close(width_mm=80, force_n=20)),\n',
        ),
    ),
    in_recipe("It is dosed in the reader.", ('doser.visit("nest"', 'doser.visit("drawer"')),
    in_recipe(
        "It is tried again from the middle.",
        (
            '        taken(cell, plate),\n        put(cell, "nest"),\n',
            '        cell.repeat(work(taken(cell, plate), put(cell, "nest")), 2),\n',
        ),
    ),
    in_recipe(
        "A success is taken for a failure.",
        (
            "        cell.retry(seen, times=2, pause_s=1),\n",
            "        seen,\n        cell.invert(reader.says(lid='closed')),\n",
        ),
    ),
    in_recipe(
        "A value has a word that there is not.",
        ("reader.clamp(on=True), jaw.open()", "reader.clamp(on='yes'), jaw.open()"),
    ),
    in_recipe("A value is forgotten.", ("incubator.incubate(minutes=minutes)", "incubator.incubate()")),
    in_recipe(
        "A verb that another device has.",
        (
            '        reader.open(),\n        loader.visit("drawer", reader.clamp',
            '        reader.open_lid(),\n        loader.visit("drawer", reader.clamp',
        ),
    ),
    in_recipe(
        "The rack gets a plate back that it has.",
        (
            '"no": [put(cell, "bin"), loader.home()]',
            '"no": [put(cell, "rack_1"), taken(cell, "rack_2"), put(cell, "rack_1"), loader.home()]',
        ),
    ),
    in_recipe(
        "It says that it ends otherwise than it does.", ('"reader.lid": "closed", ', '"reader.lid": "open", ')
    ),
    in_recipe(
        "It waits for a person who is asked nothing else, for no time.", ("at_most_s=600", "at_most_s=0")
    ),
    in_recipe(
        "A timeout ends the work of a machine.",
        (
            "        incubator.incubate(minutes=minutes),",
            "        cell.timeout(incubator.incubate(minutes=minutes), 5),",
        ),
    ),
)
STEP_BUGS = (*OF_STEPS, *OF_HABITS)
