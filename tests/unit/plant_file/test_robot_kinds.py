"""Kinds of robots that move: anybody's stand beside those shipped."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from arboleda.plant_file import loader
from arboleda.plant_file.shipped_kinds import COME_WITH_IT

from ...plants import plant_text, problems_of

CART = """\
from dataclasses import dataclass

from arboleda.kinds import GridDrive, KindError, moving_kind


@dataclass(frozen=True, kw_only=True)
class Cart:
    loaded: bool = False
    mm_s: float = 200.0

    def __post_init__(self):
        if self.mm_s > 200:
            raise KindError(f"mm_s must be at most 200, is {self.mm_s:g}")


@moving_kind("cart")
def cart(settings: Cart):
    speed = settings.mm_s / 2 if settings.loaded else settings.mm_s
    return GridDrive(rows=3, columns=3, pitch_mm=150, mm_s=speed)
"""
RECIPES = """\
from arboleda.recipes import Target, recipe, work


@recipe("fetch")
def fetch(cell, at: Target):
    return work(cell.device("cart").visit(at))
"""
PLANT = plant_text(__file__, "robot_kinds")
ENTRY = "[arboleda.kinds]\ncart = acme_carts:cart\n"


def write(folder: Path, plant: str = PLANT, cart: str = CART) -> Path:
    (folder / "cart.py").write_text(cart, "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(plant, "utf-8")
    return file


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for an installed package, which is forgotten after the test."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    yield folder
    sys.modules.pop("acme_carts", None)


def install(site: Path, entry: str = ENTRY) -> None:
    (site / "acme_carts.py").write_text(CART, "utf-8")
    about = site / "acme_carts-1.2.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: acme_carts\nVersion: 1.2\n", "utf-8")
    (about / "entry_points.txt").write_text(entry, "utf-8")


def test_an_installed_package_brings_such_a_kind(tmp_path: Path, site: Path) -> None:
    install(site)
    cart = loader.load(write(tmp_path, PLANT.replace("cart.py, ", ""))).robots["cart"]
    assert (cart.kind_name, cart.goes, bool(cart.floor_grid)) == ("cart", True, True)


def test_its_own_keys_are_read_and_others_are_named_with_their_place(tmp_path: Path) -> None:
    slow = loader.load(write(tmp_path)).robots["cart"]
    quick = loader.load(write(tmp_path, PLANT.replace("true", "false"))).robots["cart"]
    assert slow.motion.travel_s(0, (0, 1)) == 2 * quick.motion.travel_s(0, (0, 1))
    (found,) = problems_of(write(tmp_path, PLANT.replace("loaded", "loadd")))
    assert found.startswith('plant.yaml:6:26: cells.bay.devices.cart: the key "loadd" is not known;')


def test_a_kind_of_a_file_with_a_problem_is_not_taken_for_another(tmp_path: Path) -> None:
    """Its name is like that of the camera, which nobody meant."""
    (found,) = problems_of(write(tmp_path, PLANT.replace("100", "900")))
    assert found == "plant.yaml:6:13: cells.bay.devices.cart: mm_s must be at most 200, is 900"


def test_a_mistake_of_a_recipe_says_nothing_of_what_such_a_robot_carries(tmp_path: Path) -> None:
    """Until the recipe is right, no kind of a file is known."""
    file = write(tmp_path, PLANT.replace("eye: {kind: camera}", "jaw: {kind: gripper, tool_of: cart}"))
    assert loader.load(file).robots["jaw"]
    (tmp_path / "recipes.py").write_text(RECIPES.replace("visit(at)", "visit(at, at)"), "utf-8")
    assert {each.partition(": ")[0] for each in problems_of(file)} == {"recipes.py:6:1"}


def test_what_goes_may_be_shared_whosever_kind_it_is_if_it_says_where_it_is(tmp_path: Path) -> None:
    shared = PLANT.replace("cart: {kind: cart, loaded: true, mm_s: 100}", "cart: {shared: wagon}")
    told = problems_of(
        write(tmp_path, shared.replace("cells:", "shared: {wagon: {kind: cart, evidence: state}}\ncells:"))
    )
    assert any("must be ids or joints: a shared robot has to say" in each for each in told)


def test_what_such_a_kind_raises_is_told_at_its_line(tmp_path: Path) -> None:
    (found,) = problems_of(write(tmp_path, cart=CART.replace("    speed =", "    1 / 0\n    speed =")))
    assert found == "cart.py:18:1: cart: ZeroDivisionError: division by zero"


def test_a_kind_that_makes_no_robot_is_told(tmp_path: Path) -> None:
    nonsense = CART.replace("    speed =", '    return "a cart"\n    speed =')
    (found,) = problems_of(write(tmp_path, cart=nonsense))
    expected = "cart returns 'a cart'; a kind that moves returns Axes(...) or GridDrive(...)"
    assert found == f"cart.py:16:1: cart: {expected}"


def test_a_field_cannot_have_the_name_of_a_key_of_every_robot(tmp_path: Path) -> None:
    (found,) = problems_of(write(tmp_path, cart=CART.replace("loaded", "timeout_s")))
    assert "timeout_s is a key of every robot; give the field another name" in found


@pytest.mark.parametrize("name", ["arm", "mobile", "person"])
def test_a_package_cannot_take_the_name_of_a_shipped_robot(tmp_path: Path, site: Path, name: str) -> None:
    install(site, ENTRY.replace("cart =", f"{name} ="))
    told = problems_of(write(tmp_path, PLANT.replace("{kind: camera}", f"{{kind: {name}}}")))
    assert f'the kind "{name}" comes with Arboleda, and acme_carts 1.2 registers another one' in told[0]


def test_every_shipped_kind_is_in_one_list() -> None:
    robots, devices = ["arm", "mobile", "person"], ["gripper", "effector", "conveyor", "camera", "sensor"]
    assert [*COME_WITH_IT] == [*robots, *devices]
