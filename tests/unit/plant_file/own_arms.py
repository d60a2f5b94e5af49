"""Plants with an arm of their own, written into a folder."""

from __future__ import annotations

from pathlib import Path

from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.testing.storage_layout import StorageLayout

ROOT = Path(__file__).parents[3]
TENDER = ROOT / "examples/machine_tending/models/tender.urdf"
PLANT = """\
name: own
paths: {{0B: [0, 3, 4, 7]}}
cells:
  a:
    arm: {{name: ra, model: {model}, link: mqtt, evidence: ids{more}}}
    mobile: {{name: ma, link: mqtt, evidence: ids, grid: {{origin_m: [3, 3]}}}}
    home: {home}
    pickup: {pickup}
    stations: {stations}
"""


def link(name: str, shape: str = "") -> str:
    visual = f"<visual><geometry>{shape}</geometry></visual>" if shape else ""
    return f'<link name="{name}">{visual}</link>\n'


def joint(
    name: str,
    ends: str,
    kind: str = "revolute",
    axis: str = "0 0 1",
    limit: str = 'lower="-1" upper="1" velocity="2"',
    xyz: str = "0 0 0.3",
    more: str = "",
) -> str:
    """`ends` is parent and child."""
    parent, child = ends.split()
    given = f'<axis xyz="{axis}"/>' + (f'<limit effort="9" {limit}/>' if limit else "")
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/>{given}{more}</joint>\n'
    )


def robot(*parts: str) -> str:
    return '<robot name="mine">\n' + "".join(parts) + "</robot>\n"


SLIDE = 'lower="0" upper="0.5" velocity="0.4"'
GANTRY = robot(
    *(link(name, '<box size="0.1 0.1 0.1"/>') for name in ("frame", "x", "y", "z")),
    joint("along", "frame x", "prismatic", "1 0 0", SLIDE, xyz="0 0 1"),
    joint("across", "x y", "prismatic", "0 1 0", SLIDE, xyz="0 0 0"),
    joint("up", "y z", "prismatic", "0 0 1", 'lower="-0.3" upper="0.2" velocity="0.3"', xyz="0 0 0"),
)
ONE = robot(link("post"), link("beam"), joint("swing", "post beam"))


def written(folder: Path, model: str, poses: tuple[str, str, str], more: str = "") -> Path:
    """A plant file in the folder; the poses are home, pick-up and the stations."""
    home, pickup, stations = poses
    file = folder / "plant.yaml"
    file.write_text(PLANT.format(model=model, more=more, home=home, pickup=pickup, stations=stations))
    return file


def gantry(folder: Path, model: str = "gantry.urdf", more: str = "") -> PlantModel:
    (folder / "gantry.urdf").write_text(GANTRY)
    poses = ("{mm: [0, 0, 0]}", "{mm: [100, 200, -250]}", "{0: {mm: [400, 50, -250], approach_mm: 40}}")
    return loader.load(written(folder, model, poses, more))


def swing(folder: Path, urdf: str = ONE, model: str = "one.urdf", more: str = "") -> PlantModel:
    (folder / "one.urdf").write_text(urdf)
    return loader.load(written(folder, model, ("{deg: [0]}", "{deg: [30]}", "{0: {deg: [-30]}}"), more))


def tender(folder: Path, model: str | None = None, more: str = "") -> PlantModel:
    poses = (
        "{deg: [0, 0, 0, 0, 0, 0]}",
        "{deg: [90, 50.9, 86.93, 0, 42.17, 0]}",
        "{0: {deg: [0, 29.94, 95.3, 0, 54.76, 0]}, 1: {deg: [20, 29.94, 95.3, 0, 54.76, 0]}}",
    )
    return loader.load(written(folder, model or str(TENDER), poses, more))


def arm(plant: PlantModel) -> Arm:
    return StorageLayout(plant.cells[0]).arm
