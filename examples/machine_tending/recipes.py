"""How the cell tends its mill."""

from arboleda.recipes import Choice, Target, recipe, work


def sorting(cell):
    """What becomes of a part that the tender holds, by what is said of it."""
    tender, belt = cell.devices("tender", "belt")
    good = [
        belt.says(entry="clear"),
        tender.visit("belt", tender.let_go()),
        tender.home(),
        belt.clear("entry"),
    ]
    bad = [tender.visit("reject", tender.let_go()), tender.home()]
    return {"good": good, "bad": bad}


@recipe("mill", ends_with={"mill.door": "open", "mill.clamped": False})
def mill_one(cell, blank=Target("pallet"), program=Choice(1001, 1002)):
    """Mill a blank and sort it by what the camera sees."""
    loader, jaw, mill, tender, camera = cell.devices("loader", "jaw", "mill", "tender", "camera")
    tender.brings_back_to("reject")  # what it holds when a task fails has been looked at by nobody
    seen = camera.look()
    asked = cell.device("operator").ask("Is the part at the camera good?", ["good", "bad"])
    unsure = [asked, cell.choose(asked, sorting(cell))]
    return work(
        mill.open(),
        loader.visit(blank, jaw.close(width_mm=30, force_n=40)),
        loader.visit("vise", mill.clamp(on=True), jaw.open()),
        mill.close(),
        mill.run(program=program),
        mill.open(),
        tender.visit("vise", tender.grip(), mill.clamp(on=False)),
        tender.visit("lens", seen),
        cell.choose(seen, {**sorting(cell), "unsure": unsure}),
    )


@recipe("pallet", ends_with={"mill.door": "open", "mill.clamped": False})
def pallet(cell, program=Choice(1001, 1002)):
    """Have the pallet refilled, and mill the blanks on it."""
    full = cell.device("operator").ask("Is the pallet full?", ["yes", "no blanks left"], at_most_s=3600)
    blanks = [cell.run(mill_one, blank=f"slot_{slot}", program=program) for slot in (1, 2, 3, 4)]
    return work(full, cell.choose(full, {"yes": blanks, "no blanks left": cell.fail("no blanks are left")}))
