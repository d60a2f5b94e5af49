"""What the vehicle is for."""

from arboleda.recipes import Target, recipe, work


@recipe("fetch")
def fetch(cell, source=Target("shelves"), goal=Target("shelves")):
    """Carry what stands at one shelf to another."""
    cart, forks = cell.devices("cart", "forks")
    return work(cart.go(source), forks.pick(height_mm=0), cart.go(goal), forks.drop(), cart.go("home"))
