"""Each notebook of the lessons runs whole in a kernel of Jupyter and draws in place, in both languages."""

from __future__ import annotations

import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree import ElementTree as Xml

import nbformat
import pytest
from nbclient import NotebookClient
from traitlets.config import Config

from ..patience import PATIENCE_S

FOLDER = Path(__file__).parents[2] / "examples" / "notebooks"
SVG, HTML, TEXT = "image/svg+xml", "text/html", "text/plain"
BOOKS = sorted(path.name.removesuffix(".es.ipynb") for path in FOLDER.glob("*.es.ipynb"))
LANGUAGE = ', language="es"'
SAID = {
    "lessons_1_to_3": ["'sis_a 0X 7' refused", "rm_sis_a: node: 7", "(4, 13)"],
    "lessons_4_to_6": [
        "failed (device_fault",
        "(ra1 was not homed)",
        "failed (stopped_short",
        "'sis_b 0B 0' done",
    ],
    "lessons_8_to_10": ["ra_1/juntas", "'sis_a 0B 99' refused", "failed (stopped_short", "'sis_a 2B 0' done"],
}  # in both languages: what a task came to is in the plant's words


def read(book: str, ending: str) -> Any:
    return nbformat.read(FOLDER / f"{book}{ending}", as_version=4)


def sources(notebook: Any, kind: str) -> list[str]:
    return [cell.source for cell in notebook.cells if cell.cell_type == kind]


def test_there_is_a_notebook_for_each_three_lessons_but_for_that_of_ros_2() -> None:
    assert sorted(SAID) == BOOKS
    found = {path.name for path in FOLDER.glob("*.ipynb")}
    assert found == {f"{book}{ending}" for book in BOOKS for ending in (".ipynb", ".es.ipynb")}


@pytest.mark.system
@pytest.mark.parametrize("ending", [".ipynb", ".es.ipynb"])
@pytest.mark.parametrize("book", BOOKS)
def test_a_notebook_runs_whole_and_draws_in_place(
    book: str, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    notebook = read(book, ending)
    with TemporaryDirectory() as sockets:  # a short path: a port could be taken by another test meanwhile
        kernel = Config(KernelManager={"transport": "ipc", "ip": f"{sockets}/kernel"})
        where = {"metadata": {"path": FOLDER}}
        NotebookClient(notebook, config=kernel, timeout=int(PATIENCE_S), resources=where).execute()
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    outputs = [output for cell in code for output in cell.outputs]
    shown = [output.data for output in outputs if output.output_type == "execute_result"]
    drawings = [Xml.fromstring(data[SVG]) for data in shown if SVG in data]
    assert drawings and all(drawing.findall(".//{*}text") for drawing in drawings)
    assert any(drawing.findall(".//{*}polyline") for drawing in drawings)
    assert any("<table>" in data.get(HTML, "") for data in shown)
    said = "\n".join(data[TEXT] for data in shown)
    assert [words for words in SAID[book] if words not in said] == []
    assert all(output.output_type in ("execute_result", "stream") for output in outputs)


@pytest.mark.parametrize("book", BOOKS)
def test_outputs_are_not_kept(book: str) -> None:
    for ending in (".ipynb", ".es.ipynb"):
        cells = [cell for cell in read(book, ending).cells if cell.cell_type == "code"]
        assert [cell.outputs for cell in cells] == [[]] * len(cells)
        assert {cell.execution_count for cell in cells} == {None}


@pytest.mark.parametrize("book", BOOKS)
def test_both_languages_run_the_same_and_lead_to_each_other(book: str) -> None:
    english, spanish = read(book, ".ipynb"), read(book, ".es.ipynb")
    assert [cell.cell_type for cell in english.cells] == [cell.cell_type for cell in spanish.cells]
    assert [code.replace(LANGUAGE, "") for code in sources(spanish, "code")] == sources(english, "code")
    assert LANGUAGE in "".join(sources(spanish, "code"))
    texts = ["".join(sources(notebook, "markdown")) for notebook in (english, spanish)]
    headings = [re.findall(r"^(#+) ", text, re.MULTILINE) for text in texts]
    assert headings[0] and headings[0] == headings[1]
    assert f"]({book}.es.ipynb)" in texts[0] and f"]({book}.ipynb)" in texts[1]
    links = [target for text in texts for target in re.findall(r"\]\((\S+?)\)", text)]
    assert [target for target in links if not (FOLDER / target).exists()] == []
