"""What the valve does for a flask."""

from arboleda.recipes import Choice, recipe, work


@recipe("fill")
def fill(cell, ml: Choice[5, 10]):
    """Dose into a flask, where there is enough."""
    valve = cell.device("valve")
    seen = valve.level()
    filled = [valve.open(), valve.dose(ml=ml), valve.close()]
    return work(seen, cell.choose(seen, {"enough": filled, "low": cell.fail("the tank is low")}))
