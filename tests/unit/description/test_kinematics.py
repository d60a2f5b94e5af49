"""Where the tool is: the URDF against Denavit-Hartenberg products whose numbers stand here, by hand."""

from __future__ import annotations

import itertools
import math
from functools import cache

import pytest
from urdf_parser_py.urdf import Robot

from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf, root_link
from arboleda.testing import shipped
from arboleda_description.urdf import render

from .drawn import Matrix, at, place, product, read, shifted, turned

ACCURACY = 1e-6  # m, and of the unit vectors of the tool
HALF, WHOLE = math.pi / 2, math.pi

SCARA = list(itertools.product((-150, -60, 0, 45, 150), (-135, 0, 100), (0, 37.5, 100)))  # deg, deg, mm
CR10A = [  # deg
    (0, 0, 0, 0, 0, 0),
    (90, 0, 0, 0, 0, 0),
    (0, 90, 0, 0, 0, 0),
    (0, 0, 90, 0, 0, 0),
    (0, 0, 0, 90, 0, 0),
    (0, 0, 0, 0, 90, 0),
    (0, 0, 0, 0, 0, 90),
    (35, 10, 0, 0, 0, 0),
    (35, 10, 20, 0, 0, 0),
    (10, 20, 0, 0, 0, 0),
    (-30, 45, -60, 15, 90, 0),
    (30, -45, 60, -15, -90, 45),
    (120, 30, 110, -40, 75, 10),
    (-120, -30, -110, 40, -75, -10),
    (180, 60, 90, 30, -90, 180),
    (-180, -60, -90, -30, 90, -180),
    (359, 1, -1, 359, -359, 359),
    (-359, -1, 1, -359, 359, -359),
    (12.3, -45.6, 78.9, -101.1, 121.3, -141.5),
    (-98.7, 65.4, -32.1, 9.8, -7.6, 5.4),
    (300, -200, 159, 250, -310, 45),
    (-300, 200, -159, -250, 310, -45),
    (77, 88, 99, 11, 22, 33),
    (1, 2, 3, 5, 8, 13),
]


@cache
def drawn(model: str) -> Robot:
    return read(render(model, prefix=""))


def row(theta: float, d: float, a: float, alpha: float) -> Matrix:
    """One row of a DH table: about z, along z, along x, about x."""
    ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return ((ct, -st * ca, st * sa, a * ct), (st, ct * ca, -ct * sa, a * st), (0, sa, ca, d), (0, 0, 0, 1))


def scara(q1: float, q2: float, q3: float) -> Matrix:
    """Base to tool: 330 mm up, links of 650 and 520 mm, 180 mm down at q3 = 0; z of the tool is down."""
    return product(row(q1, 0.330, 0.65, 0), row(q2, 0, 0.52, WHOLE), row(0, 0.180 + q3, 0, 0))


def cr10a(q1: float, q2: float, q3: float, q4: float, q5: float, q6: float) -> Matrix:
    """Base to flange, with the maker's lengths."""
    return product(
        row(q1, 0.1765, 0, HALF),
        row(q2 - HALF, 0, -0.607, 0),
        row(q3, 0, -0.568, 0),
        row(q4 - HALF, 0.191, 0, HALF),
        row(q5, 0.125, 0, -HALF),
        row(q6, 0.1084, 0, 0),
    )


def flat(matrix: Matrix) -> list[float]:
    return [value for line in matrix for value in line]


@pytest.mark.parametrize("given", SCARA, ids=str)
def test_the_tool_of_the_scara_is_where_the_dh_table_says(given: tuple[float, float, float]) -> None:
    q = (math.radians(given[0]), math.radians(given[1]), given[2] / 1000)
    tool = place(drawn("scara"), "tool0", q)
    assert flat(tool) == pytest.approx(flat(scara(*q)), abs=ACCURACY)


@pytest.mark.parametrize("given", CR10A, ids=str)
def test_the_tool_of_the_cr10a_is_where_the_dh_table_says(given: tuple[float, ...]) -> None:
    q = tuple(math.radians(angle) for angle in given)
    tool = place(drawn("cr10a"), "tool0", q)
    assert flat(tool) == pytest.approx(flat(cr10a(*q)), abs=ACCURACY)


@pytest.mark.parametrize(
    ("model", "q", "tool"),
    [
        ("scara", (0, 0, 0), (1.17, 0, 0.15)),
        ("scara", (HALF, 0, 0.1), (0, 1.17, 0.05)),
        ("scara", (0, HALF, 0), (0.65, 0.52, 0.15)),
        ("cr10a", (0, 0, 0, 0, 0, 0), (0, -0.2994, 1.4765)),  # straight up, tool to the right
        ("cr10a", (HALF, 0, 0, 0, 0, 0), (0.2994, 0, 1.4765)),
    ],
)
def test_poses_that_need_no_table(model: str, q: tuple[float, ...], tool: tuple[float, ...]) -> None:
    assert at(place(drawn(model), "tool0", q)) == pytest.approx(tool, abs=ACCURACY)


@pytest.mark.parametrize("node", range(9))
@pytest.mark.parametrize("name", ["rm_sis_a", "rm_sis_b", "rm_sis_c"])
@pytest.mark.parametrize("kind", ["as shipped", "narrowed"])
def test_a_mobile_on_a_node_is_where_the_plant_file_puts_the_node(
    narrowed: PlantModel, kind: str, name: str, node: int
) -> None:
    plant = narrowed if kind == "narrowed" else shipped()
    mobile = plant.robots[name]
    assert isinstance(mobile, Mobile)
    (x0, y0), yaw, pitch = {
        "rm_sis_a": ((-0.1, -1.366), 0, 0.1),
        "rm_sis_b": ((1.4, -1.366), 0, 0.1),
        "rm_sis_c": ((0.55, 0.296), 0, 0.2),
    }[name]
    if kind == "narrowed":
        yaw, pitch = 30, 0.35
    robot = read(robot_urdf(plant, name))
    assert robot.get_root() == root_link(mobile) == f"{name}_grid_link"
    origin = mobile.grid.origin
    world = product(shifted(origin.x, origin.y, 0), turned((0, 0, 1), origin.yaw))
    base = product(world, place(robot, f"{name}_base_link", mobile.grid.position(node)))
    along, up = node % 3 * pitch, node // 3 * pitch  # columns, rows
    cos, sin = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    assert at(base) == pytest.approx(
        (x0 + along * cos - up * sin, y0 + along * sin + up * cos, 0), abs=ACCURACY
    )
    assert at(base, (1, 0, 0)) == pytest.approx((at(base)[0] + cos, at(base)[1] + sin, 0), abs=ACCURACY)
