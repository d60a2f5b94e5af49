"""Machines of the bench, on simulators of PyLabRobot; for real ones put their backends here."""

from arboleda_drivers.pylabrobot.adapter import machine


@machine("liquid_handler")
def liquid_handler():
    """A liquid handler of one channel: tips in slot 1, a plate in slot 2 of the deck of an OT-2."""
    from pylabrobot.liquid_handling import LiquidHandler
    from pylabrobot.liquid_handling.backends import LiquidHandlerChatterboxBackend
    from pylabrobot.resources import Cor_96_wellplate_360ul_Fb, hamilton_96_tiprack_300uL
    from pylabrobot.resources.opentrons import OTDeck

    deck = OTDeck()
    deck.assign_child_at_slot(hamilton_96_tiprack_300uL("tips"), 1)
    deck.assign_child_at_slot(Cor_96_wellplate_360ul_Fb("plate"), 2)
    return LiquidHandler(backend=LiquidHandlerChatterboxBackend(num_channels=1), deck=deck)


@machine("heated_shaker")
def heated_shaker():
    """A heated shaker that says what it is told."""
    from pylabrobot.heating_shaking import HeaterShaker, HeaterShakerChatterboxBackend
    from pylabrobot.resources import Coordinate

    return HeaterShaker(
        name="hotplate",
        size_x=140.0,
        size_y=100.0,
        size_z=60.0,
        backend=HeaterShakerChatterboxBackend(),
        child_location=Coordinate(0.0, 0.0, 60.0),
    )
