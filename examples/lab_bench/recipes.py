"""What the bench does with a sample."""

from arboleda.recipes import Choice, recipe, work


@recipe("weigh")
def weigh(cell, ml: Choice[5, 10, 20]):
    """Fill a sample and see whether it is enough."""
    pump, scale = cell.devices("pump", "scale")
    seen = scale.weigh()
    ways = {"enough": [], "short": cell.fail("the scale says that too little was dispensed")}
    return work(scale.tare(), pump.dispense(ml=ml), seen, cell.choose(seen, ways))


@recipe("incubate", ends_with={"heater.lid": "open", "heater.clamped": False, "heater.celsius": 20})
def incubate(cell, ml: Choice[5, 10], celsius: Choice[40, 60]):
    """Fill what the reader knows as a sample, and keep it warm for a while."""
    pump, heater, reader, operator = cell.devices("pump", "heater", "reader", "operator")
    code = reader.scan()
    warm = [heater.clamp(on=True), heater.close(), heater.heat(celsius=celsius), heater.heat(celsius=20)]
    ways = {
        "sample": [pump.dispense(ml=ml), *warm, heater.open(), heater.clamp(on=False), pump.rinse()],
        "blank": pump.rinse(),
        "unreadable": [operator.ask("Take the sample out, please"), cell.fail("nobody can read the code")],
    }
    return work(code, cell.choose(code, ways))
