"""What the press does with a blank."""

from arboleda.recipes import Choice, recipe, work


@recipe("form")
def form(cell, strokes: Choice[1, 2, 3]):
    """Close the guard, press, open it, and measure what came out."""
    press = cell.device("press")
    seen = press.measure()
    judged = cell.choose(seen, {"good": [], "bad": cell.fail("the part is out of measure")})
    return work(press.close(), press.press(strokes=strokes), press.open(), seen, judged)
