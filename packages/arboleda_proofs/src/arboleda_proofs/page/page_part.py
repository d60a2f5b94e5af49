"""Part of a plant's page: faults by hand, reports of failures, the demonstration."""

from __future__ import annotations

from arboleda.extension import Assets, Face, Moment, PageAct, PagePart, Place, Role, Section

from . import demo, fault_acts, fault_form, reports


def face(moment: Moment) -> Face:
    """The faults that go on, and whether a demonstration does."""
    return fault_acts.face(moment) | demo.face(moment)


PAGE = PagePart(
    assets=Assets(package=__package__, script="part.js", styles=("proofs",)),
    sections=(
        Section(place=Place.TOP, build=demo.welcome),
        Section(place=Place.TOP, build=fault_form.going_on, role=Role.OPERATOR),
        Section(place=Place.CELL_MENU, build=fault_form.drawer, role=Role.OPERATOR),
        Section(place=Place.PLANT_MENU, build=demo.end_of_it),
        Section(place=Place.CARD, build=reports.way_from_cell),
        Section(place=Place.TASK, build=reports.way_from_task),
    ),
    acts={
        demo.END: PageAct(name="demo.end", take=demo.end),
        fault_acts.BEGIN: PageAct(name="faults.title", take=fault_acts.begin),
        fault_acts.END: PageAct(name="faults.end", take=fault_acts.end),
    },
    face=face,
    serve=reports.serve,
)
