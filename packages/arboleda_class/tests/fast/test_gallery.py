"""The gallery has every plant of the playground, as its list and the plants are now."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.scripts import load

from arboleda.web.languages import LANGUAGES
from arboleda_class.playground import plants

PICTURES = Path(__file__).parents[4] / "docs/images/gallery"


@pytest.fixture(scope="module")
def gallery() -> Any:
    """The script, which reads each plant once."""
    return load("gallery")


@pytest.mark.long
@pytest.mark.parametrize("language", LANGUAGES)
def test_the_page_is_what_make_gallery_writes(gallery: Any, language: str) -> None:
    assert gallery.page_of(language).read_text("utf-8") == gallery.page(language), "make gallery"


@pytest.mark.long
def test_every_plant_has_its_pictures_and_no_picture_is_left_over(gallery: Any) -> None:
    wanted = {f"{name}-tree.svg" for name in plants.FILES}
    wanted |= {f"{name}.webp" for name in plants.FILES if gallery.has_twin(name)}
    assert {each.name for each in PICTURES.iterdir()} == wanted, "make gallery GALLERY=--pictures"


@pytest.mark.parametrize("name", plants.FILES)
def test_its_line_names_a_plant_that_is_there(gallery: Any, name: str) -> None:
    line = gallery.start(name)
    for word in line.split():
        assert not word.startswith(("examples/", "src/")) or (PICTURES.parents[2] / word).is_file(), line


def test_no_example_with_a_plant_is_missing() -> None:
    root = PICTURES.parents[2]
    found = {each.relative_to(root).as_posix() for each in root.glob("examples/*/plant.yaml")}
    assert found <= set(plants.FILES.values())
