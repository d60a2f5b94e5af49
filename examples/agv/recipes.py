"""What the vehicle is for."""

from arboleda.recipes import Target, recipe, work


@recipe("fetch")
def fetch(cell, source=Target("shelves"), goal=Target("shelves")):
    """Carry what stands at one shelf to another."""
    cart, forks = cell.devices("cart", "forks")
    seen = forks.detect_object()
    carried = [cart.go(goal), forks.drop(), cart.go("home")]
    nothing = [forks.drop(), cart.go("home"), cell.fail("nothing stood there")]
    judged = cell.choose(seen, {"loaded": carried, "empty": nothing})
    return work(cart.go(source), forks.pick(height=0.0), seen, judged)
