"""Each notebook of the lessons runs whole in a kernel of Jupyter and draws in place.

The Spanish ones run: the English ones have the same code (../fast/test_notebooks.py).
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree as Xml

import nbformat
import pytest
from nbclient import NotebookClient
from tests.patience import PATIENCE_S
from traitlets.config import Config

FOLDER = Path(__file__).parents[4] / "examples" / "notebooks"
SVG, HTML, TEXT = "image/svg+xml", "text/html", "text/plain"
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


@pytest.mark.system
@pytest.mark.parametrize("book", sorted(SAID))
def test_a_notebook_runs_whole_and_draws_in_place(
    book: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    notebook = nbformat.read(FOLDER / f"{book}.es.ipynb", as_version=4)
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
