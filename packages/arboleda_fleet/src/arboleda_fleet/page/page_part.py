"""Part of a plant's page: the OEE of its cells."""

from __future__ import annotations

from arboleda.extension import Assets, PagePart, Place, Section

from . import oee

PAGE = PagePart(
    assets=Assets(package=__package__, script="oee.js", styles=("fleet",)),
    sections=(Section(place=Place.TASKS, build=oee.build),),
    serve=oee.serve,
)
