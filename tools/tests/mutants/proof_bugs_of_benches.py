"""Bugs of plants without arms of their own task: the laboratory bench and the kitting hall."""

from __future__ import annotations

from functools import partial

from . import proof_bug

recipe, plant = partial(proof_bug.in_recipe, "lab_bench"), partial(proof_bug.in_plant, "lab_bench")
WARM = "[heater.clamp(on=True), heater.close(), heater.heat(celsius=celsius), heater.heat(celsius=20)]"
OPENED = "heater.open(), heater.clamp(on=False), pump.rinse()"
OF_THE_BENCH = (
    recipe("The heater heats with its lid open.", (WARM, WARM.replace("heater.close(), ", ""))),
    recipe("The heater heats what is not clamped.", (WARM, WARM.replace("heater.clamp(on=True), ", ""))),
    recipe(
        "The lid closes after it was to heat.",
        (
            WARM,
            WARM.replace("heater.close(), ", "").replace(
                "heater.heat(celsius=20)", "heater.close(), heater.heat(celsius=20)"
            ),
        ),
    ),
    recipe("The heater stays hot.", (WARM, WARM.replace(", heater.heat(celsius=20)", ""))),
    recipe("The heater stays closed.", (OPENED, OPENED.replace("heater.open(), ", ""))),
    recipe("The heater stays clamped.", (OPENED, OPENED.replace("heater.clamp(on=False), ", ""))),
    recipe("The heater is opened while it heats.", ("heater.heat(celsius=20)]", "heater.open()]")),
    recipe(
        "Nobody looks at the answer of the scale.",
        ("seen, cell.choose(seen, ways))", "cell.fallback(seen, []))"),
        (
            '    ways = {"enough": [], "short": cell.fail("the scale says that too little was dispensed")}\n',
            "",
        ),
    ),
    recipe(
        "It goes on by what the scale was not asked.",
        ("seen, cell.choose(seen, ways)", "cell.choose(seen, ways)"),
    ),
    recipe(
        "An answer of the reader has no way.",
        (
            '        "unreadable": [operator.ask("Take the sample out, please"), '
            'cell.fail("nobody can read the code")],\n',
            "",
        ),
    ),
    recipe("A misspelt answer has a way.", ('"blank": pump', '"blanc": pump')),
    recipe("It dispenses what the pump has not.", ("ml: Choice[5, 10, 20]", "ml: Choice[5, 10, 25]")),
    recipe("It is tried again for ever.", ("work(code,", "work(cell.retry(code, times=100_000, pause_s=1),")),
    recipe(
        "What the pump says does not matter.",
        ("pump.dispense(ml=ml), seen", "cell.fallback(pump.dispense(ml=ml), cell.wait(0.1)), seen"),
    ),
    plant("A verb has less time than it takes.", ("at_most_s: 90", "at_most_s: 9")),
    plant("Closing the lid opens it.", ("sets: {lid: closed}, takes_s", "sets: {lid: open}, takes_s")),
    plant(
        "Heating needs an open lid.",
        ("needs: {lid: closed, clamped: true}", "needs: {lid: open, clamped: true}"),
    ),
    plant("The heater needs what it does not know.", ("needs: {lid: closed,", "needs: {door: closed,")),
)

recipe, plant = partial(proof_bug.in_recipe, "kitting"), partial(proof_bug.in_plant, "kitting")
SENT = 'lift.down(), cart.visit("platform", lift.roll_in()), lift.up()'
OF_THE_HALL = (
    recipe("The lift is up when the cart comes.", (SENT, SENT.replace("lift.down(), ", ""))),
    recipe(
        "The cart rolls in before it is there.",
        (SENT, 'lift.down(), lift.roll_in(), cart.visit("platform"), lift.up()'),
    ),
    recipe(
        "The lift goes up with the cart beside it.",
        (SENT, 'lift.down(), cart.visit("platform", lift.roll_in(), lift.up())'),
    ),
    recipe("The kit is not sent up.", (SENT, SENT.replace(", lift.up()", ""))),
    recipe(
        "The part is not let go of.",
        ("picker.visit(bay, picker.let_go())", "picker.visit(bay)"),
    ),
    recipe(
        "The picker lets go before it is there.",
        ("picker.visit(bay, picker.let_go())", "picker.let_go(), picker.visit(bay)"),
    ),
    recipe("The picker does not grip.", ("picker.visit(tray, picker.grip())", "picker.visit(tray)")),
    recipe(
        "Cart and picker do two things at once.",
        ("parallel(sent(cell, 1), loaded(cell, 2, tray))", "parallel(sent(cell, 1), loaded(cell, 1, tray))"),
    ),
    recipe(
        "Two carts are sent at once.",
        ("parallel(sent(cell, 1), loaded(cell, 2, tray))", "parallel(sent(cell, 1), sent(cell, 2))"),
    ),
    recipe("The wrong bay.", ('bay = f"bay_{number}"', 'bay = f"bay_{number + 1}"')),
    recipe("Nobody brings the lift up.", ('"lift", lift.up(), seen', '"lift", seen')),
    recipe(
        "The lift rolls out what nobody has looked at.", ('"lift", lift.up(), seen, ', '"lift", lift.up(), ')
    ),
    recipe(
        "Nobody looks at what the packer says.",
        (
            'cell.choose(packed, {"yes": shuttle.home(), "no": cell.fail("the kit was not packed")})',
            'cell.choose(packed, {"yes": shuttle.home(), "maybe": []})',
        ),
    ),
    plant("The zone to the lift is forgotten.", (", free_while: {lift: {at: low}}", "")),
    plant("The lift keeps the way while it is low.", ("{lift: {at: low}}", "{lift: {at: high}}")),
    plant(
        "Rolling in needs the lift upstairs.",
        ("roll_in:  {effect: process, needs: {at: low}", "roll_in:  {effect: process, needs: {at: high}"),
    ),
    plant(
        "The lift has less time than it takes.",
        ("at: low}, takes_s: 2, at_most_s: 8", "at: low}, takes_s: 2, at_most_s: 1"),
    ),
)
BUGS_OF_BENCHES = (*OF_THE_BENCH, *OF_THE_HALL)
