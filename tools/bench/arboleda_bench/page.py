"""Page of the figures: writes those of one run of `arboleda bench --json` into docs/performance.md.

Of a benchmark with aims only the figures that have one; the others are in the file of the run.

    make performance                                             measures, and writes the page
    python -m arboleda_bench.page docs/performance.json docs/performance.md

Exit status: 0 written, 2 the page has no place for figures, or the file no figures.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from .report import number

BEGIN = "<!-- figures: made by `make performance`, not by hand -->"
END = "<!-- end of the figures -->"
HEAD = "| | | ours | floor | ratio | aim | |\n|---|---|---|---|---|---|---|"
REACHED = {True: "reached", False: "**falls short**", None: ""}
BUSY = 1.5  # load for each core: a benchmark leaves less behind
UNUSABLE = 2


def main(figures: str, page: str) -> int:
    """Write the page; return the exit status."""
    try:
        run, text = json.loads(Path(figures).read_text("utf-8")), Path(page).read_text("utf-8")
        Path(page).write_text(filled(text, run), "utf-8")
    except (OSError, ValueError, KeyError) as error:
        print(f"{page} was not written: {error}", file=sys.stderr)
        return UNUSABLE
    return 0


def filled(page: str, run: Mapping[str, Any]) -> str:
    """The page with the figures of a run between its two marks; ValueError without them."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"it has no lines {BEGIN!r} and {END!r}")
    return f"{before}{BEGIN}\n\n{block(run)}\n{END}{after}"


def block(run: Mapping[str, Any]) -> str:
    """The figures of a run as Markdown: of what it is, the table, what was not measured."""
    rows = [_row(name, each) for name, bench in run["benches"].items() for each in shown(bench["figures"])]
    missing = [f"- `{name}` was not measured: {why}" for name, why in run["not_measured"].items()]
    parts = ["\n".join(_heading(run)), "\n".join([HEAD, *rows]), "\n".join(missing)]
    return "\n\n".join(filter(None, parts)) + "\n"


def shown(figures: Sequence[Mapping[str, Any]]) -> Sequence[Mapping[str, Any]]:
    """The figures of a benchmark that have an aim; all where none has."""
    return [each for each in figures if each["aim"]] or figures


def _heading(run: Mapping[str, Any]) -> Iterator[str]:
    machine = run["machine"]
    revisions = sorted({bench["revision"] for bench in run["benches"].values()})
    yield f"Revision {', '.join(revisions)}, {run['date']}, Arboleda {run['arboleda']}."
    yield f"{machine['processor']}, {machine['cores']} cores, {machine['system']}."
    yield f"Python {machine['python']}."
    loads = [bench["load"] for bench in run["benches"].values()]
    busy = ": other programs were at work" if max(loads) > BUSY * machine["cores"] else ""
    yield f"The load of the machine before each benchmark was {min(loads):.1f} to {max(loads):.1f}{busy}."
    if run["quick"]:
        yield "A short run (`--quick`): these figures are less certain than those of a whole one."


def _row(name: str, figure: Mapping[str, Any]) -> str:
    unit, floor, ratio = figure["unit"], figure["floor"], figure["ratio"]
    cells = (
        f"`{name}`",
        figure["name"],
        f"{number(figure['ours'])} {unit}".strip(),
        "" if floor is None else f"{number(floor)} {unit}".strip(),
        "" if ratio is None else f"{number(ratio)}x",
        figure["aim"] or "",
        REACHED[figure["reached"]],
    )
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
