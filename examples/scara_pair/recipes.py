"""The recipe of both cells, beside `storage` (`sis_a 0B 7`) and `palletizing`."""

from arboleda.recipes import Path, Pick, Place, Slot, recipe, work


@recipe("fetch")
def fetch(cell, path=Path(), station=Slot("stations")):
    """Have a part brought over a path, store it, and send the mobile robot back."""
    arm, mobile = cell.devices("arm", "mobile")
    pickup = cell.handover(path)
    arm.brings_back_to(pickup)  # where a part goes that the arm still holds after a failure
    return work(
        cell.recover(
            cell.retry(mobile.follow(path), times=2, pause_s=1),
            mobile.home(),  # if it cannot get there: out of the way
        ),
        arm.tour(Pick(pickup), Place(station), "home"),
        mobile.home(),
    )
