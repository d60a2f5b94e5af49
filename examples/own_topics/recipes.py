"""Recipes of the cells of these plants; each cell says which it offers."""

from arboleda.recipes import Choice, recipe, work


@recipe("light")
def light(cell, to=Choice("on", "off")):
    """Switch the lamp."""
    return cell.device("lamp").turn(to=to)


@recipe("shade")
def shade(cell, to=Choice("shut", "open")):
    """Move the blind, and light the room while it is shut."""
    blind, lamp = cell.devices("blind", "lamp")
    return work(blind.move(to=to), lamp.turn(to="on" if to == "shut" else "off"))


@recipe("measure")
def measure(cell):
    """Switch the lamp on, see how many watts it takes, and switch it off."""
    lamp = cell.device("lamp")
    watts = lamp.measure()
    seen = cell.choose(watts, {"< 2000": [], ">= 2000": cell.fail("it takes too much")})
    return work(lamp.turn(to="on"), watts, seen, lamp.turn(to="off"))


@recipe("enter")
def enter(cell):
    """Light the room for a while, if its door is open."""
    door, lamp = cell.devices("door", "lamp")
    return work(
        door.becomes(door="open", at_most_s=10), lamp.turn(to="on"), cell.wait(2), lamp.turn(to="off")
    )


@recipe("warm")
def warm(cell):
    """Heat for a while, if a thermometer says that it is cold; the heater itself tells nothing."""
    heater, meter = cell.devices("heater", "meter")
    return work(
        meter.becomes(celsius="< 20", at_most_s=10), heater.turn(to="on"), cell.wait(5), heater.turn(to="off")
    )


@recipe("signal")
def signal(cell, colour=Choice("green", "red")):
    """Show a colour on the strip."""
    strip = cell.device("strip")
    return work(strip.paint(to=colour), strip.dim(to=255))


@recipe("reach")
def reach(cell):
    """Turn the arm away, close its jaw, and come back."""
    arm = cell.device("arm")
    return work(arm.turn(to=90), arm.grip(to="closed"), arm.turn(to=0), arm.grip(to="open"))


@recipe("clean")
def clean(cell):
    """Clean the hall, and drive home."""
    robot = cell.device("robot")
    return work(robot.clean(), robot.home())


@recipe("print")
def print_part(cell, part=Choice("cube", "gear")):
    """Home the axes, and print a part."""
    axes, job = cell.devices("axes", "job")
    return work(axes.home(), job.make(part=part))


@recipe("load")
def load(cell):
    """Show for a while that the cart may be loaded, if it stands."""
    cart, lamp = cell.devices("cart", "lamp")
    return work(
        cart.becomes(driving=False, at_most_s=10), lamp.turn(to="on"), cell.wait(2), lamp.turn(to="off")
    )


@recipe("dose")
def dose(cell, ml: Choice[5, 10]):
    """Dose once."""
    return cell.device("pump").dose(ml=ml)
