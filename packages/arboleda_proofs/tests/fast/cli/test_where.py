"""Plant that is simulated and proved."""

from __future__ import annotations

from pathlib import Path

import yaml
from tests.unit.cli.test_where import Typed
from tests.unit.cli.test_where import lab as lab
from tests.unit.cli.test_where import own_folder as own_folder
from tests.unit.cli.test_where import typed as typed

from arboleda.cli.plant_options import plant_here
from arboleda_proofs.campaigns.request import Request


def test_the_plant_of_the_working_directory_is_simulated_unless_a_file_of_faults_is_of_another(
    own_folder: Path,
) -> None:
    here = plant_here(None)
    assert [plant.name for plant in Request(plant_here=here).plants.plants] == ["own"]
    of_shipped = own_folder / "out.yaml"
    of_shipped.write_text(yaml.safe_dump({"plant": "arboleda", "faults": []}), "utf-8")
    request = Request(plant_here=here, faults=str(of_shipped))
    assert [plant.name for plant in request.plants.plants] == ["arboleda"]


def test_an_option_is_no_second_plant_file_beside_that_of_the_environment(lab: Path, typed: Typed) -> None:
    for words in (("--plant", "nowhere.yaml"), ("nowhere.yaml",)):
        _, _, complaint = typed("prove", *words, "--budget", "1s")
        assert "nowhere.yaml: there is no such file" in complaint
    status, _, complaint = typed("prove", "nowhere.yaml", "--plant", str(lab))
    assert status == 2 and "nowhere.yaml" in complaint
