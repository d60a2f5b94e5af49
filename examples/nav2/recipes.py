"""What the base does."""

from arboleda.recipes import Target, recipe, work


@recipe("round")
def round_(cell, first=Target("stops"), second=Target("stops")):
    """Drive to one stop, then to another, and home."""
    cart = cell.device("cart")
    return work(cart.go(first), cart.go(second), cart.home())
