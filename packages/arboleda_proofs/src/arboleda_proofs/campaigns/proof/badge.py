"""Badge of a proof for one's own README: a small SVG that needs no network."""

from __future__ import annotations

from html import escape

from .proof_tally import ProofTally

LABEL = "every single fault"
HELD, SAMPLE, BROKEN = "#2e7d32", "#8a6d00", "#b42318"  # white stands out on each
LETTER, HEIGHT, MARGIN = 6.6, 20, 6  # px; a letter's width is that of the widest usual font
SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" role="img"
 aria-label="{label}: {said}">
<title>{label}: {said}</title>
<rect width="{middle}" height="{height}" fill="#444"/>
<rect x="{middle}" width="{rest}" height="{height}" fill="{color}"/>
<g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11">
<text x="{margin}" y="14">{label}</text><text x="{at}" y="14">{said}</text>
</g></svg>
"""


def badge(tally: ProofTally, total: int, *, broken: bool) -> str:
    """The content of the file; never more than a sample where not all was run."""
    runs = tally.runs
    each = "all" if tally.proof.is_at_every_instant else "each class,"
    share = each if tally.is_whole(total) else f"{runs:,} of"
    text = "broken" if broken else f"held: {share} {total:,}" if runs else "nothing was run"
    color = BROKEN if broken else HELD if tally.is_whole(total) else SAMPLE
    middle = round(len(LABEL) * LETTER + 2 * MARGIN)
    rest = round(len(text) * LETTER + 2 * MARGIN)
    return SVG.format(
        width=middle + rest,
        height=HEIGHT,
        label=escape(LABEL),
        said=escape(text),
        middle=middle,
        rest=rest,
        color=color,
        margin=MARGIN,
        at=middle + MARGIN,
    )
