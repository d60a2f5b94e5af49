"""What the line does with a part once a vehicle can take it away."""

from arboleda.recipes import Choice, Target, recipe, work


@recipe("ship")
def ship(cell, part=Target("tray"), speed=Choice(100, 200, 400)):
    """Lay a part on the belt, load it at the exit onto the vehicle, and drive it to the dock."""
    arm, belt, cart = cell.devices("arm", "belt", "cart")
    picker, jaw = cell.devices("picker", "jaw")
    return work(
        belt.gate(to="open"),
        arm.visit(part, arm.grip()),
        arm.visit("entry", arm.let_go()),
        arm.home(),
        belt.load(),
        belt.advance(to="exit", speed_mm_s=speed),
        belt.gate(to="closed"),
        cart.go("ramp"),
        jaw.open(),
        picker.visit("exit", jaw.close(width_mm=5.0, force_n=40.0)),
        picker.visit("deck", jaw.open()),
        picker.home(),
        cart.go("dock"),
        cart.go("home"),
    )
