from __future__ import annotations

import io
import sys
import xml.etree.ElementTree as ElementTree
from typing import Any

import pydot
import pytest
from PIL import Image

from arboleda.adapters.png import SCALE, plain
from arboleda.cli.draw import Format, draw
from arboleda.drawing.picture import LOOKS, MARK, Box, Word, picture
from arboleda.model.errors import StartError

SVG = "{http://www.w3.org/2000/svg}"


def row(path: str, name: str, kind: str, status: str = "INVALID", feedback: str = "") -> dict[str, Any]:
    return {"path": path, "name": name, "kind": kind, "status": status, "feedback": feedback}


ROWS = [
    row("root", "storage", "selector", "RUNNING"),
    row("0", "main", "sequence", "FAILURE"),
    row("0.0", 'drive "0B"', "command", "SUCCESS"),
    row("0.1", "mover al camión", "command", "FAILURE", "ra1: <stopped> short"),
    row("1", "recovery", "sequence"),
    row("1.0", "settle & wait", "await"),
]
NAMES = [each["name"] for each in ROWS]


def test_an_svg_names_every_node_in_its_status() -> None:
    root = ElementTree.fromstring(draw(ROWS, "svg"))
    words = [each.text for each in root.iter(f"{SVG}text")]
    assert [word for word in words if word != "?"] == NAMES
    boxes = list(root.iter(f"{SVG}rect"))[1:]
    assert [box.get("stroke") for box in boxes] == [LOOKS[each["status"]].edge for each in ROWS]


def test_every_name_fits_into_its_box() -> None:
    widest = 7.6  # px per character in the widest common font
    shapes = picture(ROWS).shapes
    boxes = [shape for shape in shapes if isinstance(shape, Box)]
    words = [shape for shape in shapes if isinstance(shape, Word) and shape.text != "?"]
    assert len(words) == len(ROWS)
    for box, word in zip(boxes, words, strict=True):
        assert word.x + widest * len(word.text) <= box.x + box.width - MARK / 2


def test_a_png_shows_each_status_in_its_colour() -> None:
    image = Image.open(io.BytesIO(draw(ROWS, "png")))
    drawn = picture(ROWS)
    assert image.size == (round(drawn.width * SCALE), round(drawn.height * SCALE))
    colours = {"#{:02x}{:02x}{:02x}".format(*colour) for _, colour in image.getcolors(1 << 20)}
    assert {LOOKS[each["status"]].fill for each in ROWS} <= colours


def test_a_png_has_words_in_every_box() -> None:
    image = Image.open(io.BytesIO(draw(ROWS, "png"))).convert("L")
    words = [shape for shape in picture(ROWS).shapes if isinstance(shape, Word)]
    for word in words:
        right = word.x + 5 * len(word.text)
        around = [value * SCALE for value in (word.x, word.y - 6, right, word.y + 6)]
        assert image.crop(tuple(map(round, around))).getextrema()[0] < 80, f"{word.text} is not there"


@pytest.mark.parametrize(
    ("text", "drawn"),
    [("camión", "camion"), ("ñandú", "nandu"), ("→ a", "? a"), ("pick-up 0B", "pick-up 0B")],
)
def test_a_png_writes_what_its_font_has(text: str, drawn: str) -> None:
    assert plain(text) == drawn


def test_ascii_shows_statuses_and_feedback_only_where_asked() -> None:
    assert draw(ROWS, "ascii").decode().splitlines()[3] == "        --> mover al camión"
    told = draw(ROWS, "ascii", statuses=True).decode().splitlines()
    assert told[0] == "{o} storage [*]"
    assert told[3] == "        --> mover al camión [x] -- ra1: <stopped> short"


def test_dot_has_a_node_per_row_and_an_edge_to_each_but_the_root() -> None:
    lines = draw(ROWS, "dot").decode().splitlines()
    assert sum("->" in line for line in lines) == len(ROWS) - 1
    assert r'  "0.0" [label="drive \"0B\"", fillcolor="#e5f3e9", color="#17713a"];' in lines


@pytest.mark.long
@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # pydot's parser, not ours
def test_the_graph_is_in_the_language_of_graphviz() -> None:
    (graph,) = pydot.graph_from_dot_data(draw(ROWS, "dot").decode())
    assert len(graph.get_edges()) == len(ROWS) - 1
    assert {node.get_name() for node in graph.get_nodes()} >= {f'"{each["path"]}"' for each in ROWS}


def test_every_format_is_drawn() -> None:
    assert all(draw(ROWS, format) for format in Format if format is not Format.XML)  # of a package


def test_a_png_without_its_library_is_one_sentence_with_the_line_to_type(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delitem(sys.modules, "arboleda.adapters.png")
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(StartError, match=r"Pillow .* pip install .*'arboleda\[pictures\]'.* --format svg"):
        draw(ROWS, "png")
