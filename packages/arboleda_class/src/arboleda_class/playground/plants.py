"""The plants that the playground offers: the shipped ones, the starter and the examples."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path
from tempfile import TemporaryDirectory

from arboleda.extension import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import examples, loader
from arboleda_proofs.campaigns.plants import Plant

STARTER = "starter"
FILES = {
    "arboleda": "plants/plant.yaml",
    "shared": "plants/shared.yaml",
    STARTER: "starter/plant.yaml",
    "lessons": "examples/plants/lessons.yaml",
    "agv": "examples/agv/plant.yaml",
    "assembly": "examples/assembly/plant.yaml",
    "kitting": "examples/kitting/plant.yaml",
    "lab_bench": "examples/lab_bench/plant.yaml",
    "machine_tending": "examples/machine_tending/plant.yaml",
    "mixed": "examples/mixed/plant.yaml",
    "nav2": "examples/nav2/plant.yaml",
    "own_board": "examples/own_board/plant.yaml",
    "own_driver": "examples/own_driver/plant.yaml",
    "own_tree": "examples/own_tree/plant.yaml",
    "plc_conveyor": "examples/plc_conveyor/plant.yaml",
    "press_board": "examples/press_board/plant.yaml",
    "ros2_control": "examples/ros2_control/plant.yaml",
    "scara_pair": "examples/scara_pair/plant.yaml",
}
"""By the name in an address, the file in the package."""
FIRST = next(iter(FILES))


def texts(name: str) -> tuple[str, dict[str, str]]:
    """The name of its plant file, and the texts of all files that are read for it, by their names."""
    with as_file(files("arboleda").joinpath(FILES[name])) as file, TemporaryDirectory() as made:
        path = file
        if name == STARTER:
            for each in file.parent.glob("*.*"):
                text = each.read_text("utf-8").replace(examples.NAMED, STARTER)
                Path(made, each.name).write_text(text, "utf-8")
            path = Path(made, file.name)
        return texts_of(path)


def texts_of(file: Path) -> tuple[str, dict[str, str]]:
    """The same for any plant file."""
    read = loader.load_with_files(file)[1]
    return read.plant, {name: content.decode("utf-8") for name, content in read.contents.items()}


def model(name: str) -> PlantModel:
    """The plant with virtual boards alone; ConfigError for a name that is not in FILES."""
    if name not in FILES:
        raise ConfigError((f"there is no plant {name!r} here; there are {', '.join(FILES)}",))
    with as_file(files("arboleda").joinpath(FILES[name].rpartition("/")[0])) as folder:
        content = folder.joinpath(FILES[name].rpartition("/")[2]).read_bytes()
        if name == STARTER:
            content = content.replace(examples.NAMED.encode(), STARTER.encode())
        return Plant(declared=loader.parse(FILES[name], content, folder)).model
