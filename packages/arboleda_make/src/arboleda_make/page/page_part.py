"""Part of a plant's page: Make, Draw, Teach and Changes."""

from __future__ import annotations

from fastapi import FastAPI

from arboleda.extension import Assets, PageApi, PagePart, Place, Role, Section

from . import findings_route, make_panel, proof, teach_panel, tree_editor, versions


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer what the scripts ask for."""
    for each in (versions, proof, findings_route):
        each.serve(server, plant)


PAGE = PagePart(
    assets=Assets(package=__package__, script="part.js", styles=("draw", "teach", "make")),
    sections=(
        Section(place=Place.TAB, name="make", build=make_panel.build, role=Role.OPERATOR),
        Section(place=Place.TAB, name="draw", within="make", build=tree_editor.build),
        Section(place=Place.TAB, name="teach", within="make", build=teach_panel.build, role=Role.OPERATOR),
        Section(place=Place.TREE, build=teach_panel.way_from_tree),
        Section(place=Place.SETTINGS, build=versions.build),
    ),
    face=teach_panel.face,
    serve=serve,
)
