"""Proof of a draft: `arboleda prove` on the recipes that are named, or on all."""

from __future__ import annotations

import json
from collections.abc import Callable
from io import StringIO
from pathlib import Path

from rich.console import Console

from arboleda_proofs.campaigns.proof.proof_campaign import ProofCampaign
from arboleda_proofs.campaigns.proof.proof_lines import ProofLines
from arboleda_proofs.campaigns.proof.proof_request import ProofRequest
from arboleda_proofs.campaigns.workers import Processes

from .extract import shown
from .process import Errand, errand, say, write

JSON, HTML, TEXT = "proof.json", "proof.html", "proof.txt"
RESULT = "result.json"
SCREEN = 110  # columns of the text


def main() -> None:
    """Run the errand of this process."""
    with errand() as given:
        given.plant()
        prove(given)


def prove(given: Errand) -> None:
    """Prove, and write the answer as JSON and as a page, with the real names of files."""
    wanted, folder = given.wanted, given.folder
    request = ProofRequest(
        plant=given.shade.plant_file,
        recipes=tuple(wanted.get("recipes", ())),
        kinds=tuple(wanted.get("kinds", ())),
        budget_s=float(wanted["budget_s"]),
        folder=Path(wanted["kept"]),
        json=folder / JSON,
        html=folder / HTML,
        mend=True,
    )
    screen = StringIO()
    console = Console(file=screen, width=SCREEN, highlight=False)
    ProofCampaign(request, console, ProofLines(ProgressOnly())).run(Processes(1))
    (folder / TEXT).write_text(screen.getvalue(), "utf-8")
    for name in (JSON, HTML, TEXT):
        _rename(folder / name, given.shade.renamed)
    write(folder / RESULT, shown(json.loads((folder / JSON).read_text("utf-8"))))


def _rename(file: Path, renamed: Callable[[str], str]) -> None:
    file.write_text(renamed(file.read_text("utf-8")), "utf-8")


class ProgressOnly(StringIO):
    """Reader of a proof's lines who passes on how far it is; the answer goes into files."""

    def write(self, line: str) -> int:
        progress = json.loads(line).get("progress")
        if progress is not None:
            say(doing=progress["phase"], done=progress["done"], total=progress["of"])
        return len(line)
