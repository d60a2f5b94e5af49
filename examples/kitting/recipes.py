"""How kits are picked, sent up and packed."""

from arboleda.recipes import Choice, Target, parallel, recipe, work


def loaded(cell, number, tray):
    """A cart is in its bay, with a part from a tray on it."""
    picker, cart = cell.devices("picker", f"cart_{number}")
    bay = f"bay_{number}"
    return work(parallel(cart.go(bay), picker.visit(tray, picker.grip())), picker.visit(bay, picker.let_go()))


def sent(cell, number):
    """What a cart brings goes up, and the cart goes home."""
    cart, lift = cell.devices(f"cart_{number}", "lift")
    return cell.using("lift", lift.down(), cart.visit("platform", lift.roll_in()), lift.up())


@recipe("kit", ends_with={"lift.at": "high"})
def kit(cell, cart=Choice(1, 2, 3), tray=Target("trays")):
    """Load one cart and send its kit up."""
    return work(loaded(cell, cart, tray), sent(cell, cart), cell.device("picker").home())


@recipe("wave", ends_with={"lift.at": "high", "bay_1": 1, "bay_2": 1, "bay_3": 1})
def wave(cell, tray=Target("trays")):
    """Load all three carts, each while the one before it is on its way."""
    return work(
        loaded(cell, 1, tray),
        parallel(sent(cell, 1), loaded(cell, 2, tray)),
        parallel(sent(cell, 2), loaded(cell, 3, tray)),
        parallel(sent(cell, 3), cell.device("picker").home()),
    )


@recipe("collect")
def collect(cell):
    """Take a kit off the lift and have it packed."""
    lift, shuttle, packer = cell.devices("lift", "shuttle", "packer")
    seen = lift.look()
    taken = {"kit": shuttle.visit("landing", lift.roll_out()), "empty": cell.fail("no kit is on the lift")}
    packed = packer.ask("Is the kit packed?", ["yes", "no"], at_most_s=3600)
    return work(
        cell.using("lift", lift.up(), seen, cell.choose(seen, taken)),
        shuttle.go("table"),
        packed,
        cell.choose(packed, {"yes": shuttle.home(), "no": cell.fail("the kit was not packed")}),
    )
