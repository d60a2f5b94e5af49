"""Recipes of the laboratory for its plates."""

from arboleda.recipes import Choice, Target, parallel, recipe, work


def taken(cell, target):
    """The plate at a target is taken."""
    loader, jaw = cell.devices("loader", "jaw")
    return loader.visit(target, jaw.close(width_mm=80, force_n=20))


def put(cell, target):
    """The plate is put at a target."""
    loader, jaw = cell.devices("loader", "jaw")
    return loader.visit(target, jaw.open())


def dosed(cell, ul):
    """The plate in the nest gets a reagent, with a tip of its own."""
    doser, pipette = cell.devices("doser", "pipette")
    return work(
        doser.visit("tips", pipette.take_tip()),
        doser.visit("trough", pipette.aspirate(ul=ul)),
        doser.visit("nest", pipette.dispense()),
        doser.visit("waste", pipette.eject()),
        doser.home(),
    )


def incubated(cell, minutes):
    """The plate in the jaw is kept warm."""
    incubator = cell.device("incubator")
    return work(
        incubator.open(),
        put(cell, "inside"),
        incubator.close(),
        incubator.incubate(minutes=minutes),
        incubator.open(),
        taken(cell, "inside"),
        incubator.close(),
    )


def sent(cell):
    """The plate in the jaw goes to the store."""
    mover = cell.device("mover")
    return work(mover.to_lab(), put(cell, "deck"), cell.device("loader").home(), mover.to_store())


@recipe("assay", ends_with={"incubator.door": "closed", "reader.lid": "closed", "pipette.tip": False})
def assay(cell, plate=Target("racks"), ul=Choice(50, 100), minutes=Choice(10, 30)):
    """Dose a plate, incubate it, read it, and send it to the store if it is clear."""
    loader, jaw, reader, ana = cell.devices("loader", "jaw", "reader", "ana")
    loader.brings_back_to("bin")
    seen = reader.read()
    asked = ana.ask("Keep this plate?", ["yes", "no"], at_most_s=600)
    ways = {"yes": sent(cell), "no": [put(cell, "bin"), loader.home()]}
    return work(
        taken(cell, plate),
        put(cell, "nest"),
        dosed(cell, ul),
        taken(cell, "nest"),
        incubated(cell, minutes),
        reader.open(),
        loader.visit("drawer", reader.clamp(on=True), jaw.open()),
        reader.close(),
        cell.retry(seen, times=2, pause_s=1),
        reader.open(),
        loader.visit("drawer", jaw.close(width_mm=80, force_n=20), reader.clamp(on=False)),
        reader.close(),
        cell.choose(seen, {"clear": sent(cell), "unclear": [asked, cell.choose(asked, ways)]}),
    )


@recipe("warm_up")
def warm_up(cell, plate=Target("racks"), minutes=Choice(10, 30)):
    """Incubate a plate while a tip is thrown away that may be left, and throw the plate away, too."""
    doser, pipette, loader = cell.devices("doser", "pipette", "loader")
    loader.brings_back_to("bin")
    fresh = work(doser.visit("tips", pipette.take_tip()), doser.visit("waste", pipette.eject()), doser.home())
    return work(
        taken(cell, plate),
        parallel(incubated(cell, minutes), fresh),
        put(cell, "bin"),
        loader.home(),
    )


@recipe("put_away")
def put_away(cell, shelf=Target("shelves")):
    """Bring a plate from the mover to a shelf."""
    crane, claw, mover = cell.devices("crane", "claw", "mover")
    return work(
        mover.to_store(),
        crane.visit("deck", claw.close(width_mm=80, force_n=20)),
        crane.visit(shelf, claw.open()),
        crane.home(),
    )
