"""Offers of what a plant file does not state, as steps of a draft."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.plant_check.test_unstated import GUARD, NEEDS, PLACES, PLANT, RECIPE, written

from arboleda.model.plant_files import PlantFiles
from arboleda.plant_check import draft_check, unstated
from arboleda.plant_file import loader
from arboleda_make.drafts.draft import draft_of
from arboleda_proofs.campaigns.plant_notes import notes
from arboleda_proofs.campaigns.plants import Plant


def test_what_a_file_does_not_state_is_offered_with_its_place_in_the_file(tmp_path: Path) -> None:
    model = loader.load(written(tmp_path, PLANT, RECIPE))
    assert unstated.notes(model) == (
        f"{PLACES}; cells.lab.places: {{inside: {{output: true}}, rack: {{supply: true}}}} would state it",
        f"{GUARD}; zones.in_the_oven.free_while: "
        "{oven: {door: open}} or {oven: {door: closed}} would state it",
        f"{NEEDS}; kinds.oven.verbs.bake.needs: {{door: closed}} or {{door: open}} or {{}} would state it",
    )
    assert notes([Plant(declared=model)]) == [PLACES, GUARD, NEEDS], "as simulate and prove say it"


@pytest.mark.parametrize("number", range(3))
def test_an_offer_for_a_draft_is_a_step_of_it(tmp_path: Path, number: int) -> None:
    file = written(tmp_path, PLANT, RECIPE)
    draft = draft_of(PlantFiles(plant=file.name, contents={file.name: file.read_bytes()}))
    offer = draft_check.check(draft.files, file).unstated[number]
    for value in offer.values:
        found = draft_check.check(draft.with_value(offer.place, value).files, file)
        assert found.problems == () and offer.unknown not in [each.unknown for each in found.unstated]
