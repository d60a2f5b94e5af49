"""What the docs say of the operators' verbs is what the command line and the API say."""

from __future__ import annotations

from pathlib import Path

from arboleda.model.messages import Verb
from arboleda.views.verb_words import ABOUT

PAGE = Path(__file__).parents[2] / "docs/how-to/operate.md"


def test_every_verb_has_its_row_in_the_docs() -> None:
    rows = [
        f"| `{verb.value}` | {words.does} | {words.refused} | {', '.join(words.scopes)} |"
        for verb, words in ABOUT.items()
    ]
    section = PAGE.read_text(encoding="utf-8").partition("## Verbs\n")[2].partition("\n## ")[0]
    assert [line for line in section.splitlines() if line.startswith("| `")] == rows
    assert list(ABOUT) == list(Verb)
