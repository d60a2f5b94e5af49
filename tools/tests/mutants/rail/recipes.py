"""Recipes of the two cells for a part."""

from arboleda.recipes import Choice, Target, recipe, work


@recipe("bake", ends_with={"oven.door": "closed", "carriage.at": "south", "jaw.gripped": False})
def bake(cell, tray=Target("trays")):
    """Bake a part and send it to the south."""
    arm, jaw, oven, carriage = cell.devices("arm", "jaw", "oven", "carriage")
    return work(
        oven.open(),
        arm.visit(tray, jaw.close(width_mm=40, force_n=20)),
        arm.visit("inside", jaw.open()),
        oven.close(),
        oven.bake(),
        oven.open(),
        arm.visit("inside", jaw.close(width_mm=40, force_n=20)),
        carriage.to_north(),
        arm.visit("deck", jaw.open()),
        arm.home(),
        oven.close(),
        carriage.to_south(),
    )


@recipe("fasten", ends_with={"changer.tool": "none", "claw.gripped": False, "box": 1})
def fasten(cell, screws=Choice(1, 2)):
    """Screw a part together on the carriage, and pack it where it is heavy enough."""
    arm, claw, changer, scale, carriage = cell.devices("arm", "claw", "changer", "scale", "carriage")
    arm.brings_back_to("box")
    weight = scale.weigh()
    return work(
        carriage.to_south(),
        changer.take_driver(),
        [changer.drive() for _ in range(screws)],
        changer.put_back(),
        changer.take_brush(),
        changer.sweep(),
        changer.put_back(),
        arm.visit("deck", claw.close(width_mm=40, force_n=20)),
        cell.retry(weight, times=2, pause_s=1),
        arm.visit("box", claw.open()),
        arm.home(),
        cell.choose(weight, {"full": [], "light": cell.fail("the part is too light")}),
    )
