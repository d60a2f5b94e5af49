"""A proof as one HTML file that needs no network: every language in it, one of them shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

from arboleda.dashboard.findings import findings
from arboleda.drawing.folding import folded
from arboleda.drawing.words import outline
from arboleda.extension import Words, words
from arboleda.web.languages import FIRST, LANGUAGES, texts
from arboleda_proofs.simulator.faults.titles import title

from ..from_above import as_svg
from ..setting import rules
from ..words import fault_said
from .calm import Calm
from .checks import Check, tried_checks
from .equal_cells import notes
from .instants import Instant
from .moment import Moment
from .outcome import MOST_ACTS, End
from .pairs import PairTally
from .proof_tally import Case, ProofTally, RecipeKey, Row
from .pytest_file import Breach, as_tests

PART = "proof"
SHOWN = (End.DONE, End.RECOVERED, End.HELD, End.FAILED)
HEADS = ("fault", "runs", *(end.value for end in SHOWN), "other", "not_noticed", "broken", "ready", "causes")
STYLE = """
body{font:15px/1.45 system-ui,sans-serif;max-width:75rem;margin:1rem auto;padding:0 1rem}
body{color:#1b1f24;background:#fff}h1{font-size:1.4rem}h2{font-size:1.1rem;margin-top:1.6rem}
pre{font:12px/1.4 ui-monospace,monospace;overflow:auto;background:#f6f8fa;padding:.5rem}
table{border-collapse:collapse;font-size:13px}.wide{overflow-x:auto}
td,th{padding:.1rem .6rem;text-align:right;border-bottom:1px solid #d0d7de}
td:first-child,th:first-child,td:last-child,th:last-child{text-align:left}
.bad{color:#b42318;font-weight:bold}.quiet{color:#57606a}"""
SCRIPT = """const root = document.documentElement, languages = %s
const spoken = (navigator.language || '').slice(0, 2)
if (languages.includes(spoken)) root.lang = spoken
document.getElementById('language').onclick = () => {
  root.lang = languages[(languages.indexOf(root.lang) + 1) %% languages.length]
}"""
POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


@dataclass(frozen=True, kw_only=True)
class ProofPage:
    """The contents of the page; `total`: so many runs there are in all."""

    name: str
    plant: Path | None
    calm: Sequence[Calm]
    tally: ProofTally
    breaches: Sequence[Breach]
    total: int
    pairs: PairTally | None = None


def page(proof: ProofPage) -> str:
    """The content of the file."""
    hidden = ",".join(f"html[lang={each}] body [lang]:not([lang={each}])" for each in LANGUAGES)
    names = " / ".join(escape(texts(each, "page")["name"]) for each in LANGUAGES)
    head = escape(texts(FIRST, PART)["title"].format(plant=proof.name))
    return "\n".join(
        [
            f'<!doctype html><html lang="{FIRST}"><head><meta charset="utf-8"><title>{head}</title>',
            f'<meta name="viewport" content="width=device-width"><meta http-equiv="Content-Security-Policy" '
            f'content="{POLICY}"><style>{STYLE}\n{hidden}{{display:none}}</style></head><body>',
            f'<button id="language">{names}</button>',
            *_parts(proof),
            f"<script>{SCRIPT % list(LANGUAGES)}</script></body></html>",
            "",
        ]
    )


def _parts(proof: ProofPage) -> Iterator[str]:
    yield f"<h1>{_each('title', plant=proof.name)}</h1>"
    yield from _amount(proof)
    yield f"<h2>{_each('unnoticed')}</h2><p class=quiet>{_each('unnoticed_note')}</p>"
    unnoticed = proof.tally.unnoticed()
    found = "".join(
        _unnoticed(case, count, tried_checks(proof.tally.proof, case)) for case, count in unnoticed
    )
    nothing = f"<li>{_each('nothing')}</li>"
    yield f"<ul>{found or nothing}</ul>"
    unmended = "".join(_unmended(*each) for each in proof.tally.unmended())
    yield f"<h2>{_each('unmended')}</h2><p class=quiet>{_each('unmended_note', acts=MOST_ACTS)}</p>"
    yield f"<ul>{unmended or nothing}</ul>"
    yield f"<h2>{_each('breaches')}</h2>"
    yield from (_breach(each, proof.plant) for each in proof.breaches)
    yield "" if proof.breaches else f"<p>{_each('nothing')}</p>"
    yield f"<h2>{_each('calm')}</h2><ul>{''.join(map(_calm, proof.calm))}</ul>"
    yield from (_table(key, rows) for key, rows in proof.tally.table().items())
    yield f"<p class=quiet>{_each('table_note')}</p>"


def _amount(proof: ProofPage) -> Iterator[str]:
    done, share = proof.tally.runs, f"{proof.tally.runs / max(proof.total, 1):.0%}"
    is_whole = proof.tally.is_whole(proof.total)
    shown = ("all" if proof.tally.proof.is_at_every_instant else "classes") if is_whole else "some"
    represented = f"{proof.tally.proof.represented:,}"
    amount = _each(shown, done=f"{done:,}", total=f"{proof.total:,}", share=share, represented=represented)
    kinds = proof.tally.proof.kinds
    only = f" {_kinds(kinds)}" if kinds else ""
    alone = _each("alone", share=f"{proof.tally.alone:.1%}") if done else ""
    yield f"<p>{amount}{only} {alone}</p>"
    yield from (f"<p>{_found(note)}</p>" for note in notes(proof.tally.proof.model))
    if proof.pairs is not None:
        counts = {"done": f"{proof.pairs.runs:,}", "total": f"{proof.pairs.pairs.total:,}"}
        yield f"<p>{_each('pairs', **counts)}</p>"


def _kinds(kinds: Sequence[str]) -> str:
    """The kinds of faults that were tried alone, in every language."""
    named = {each: ", ".join(findings(each)(title(kind)) for kind in kinds) for each in LANGUAGES}
    said = ((each, texts(each, PART)["kinds"].format(kinds=names)) for each, names in named.items())
    return "".join(f"<span lang={each}>{escape(text)}</span>" for each, text in said)


def _calm(calm: Calm) -> str:
    name, outcome = escape(calm.scenario.name), calm.run.outcome
    if outcome.broken is not None:
        return f"<li class=bad>{name}: {_found(outcome.broken[1])}</li>"
    if outcome.end is End.DONE and calm.is_sound:
        again = f"; {_each('calm_again')} {_found(calm.again)}" if calm.again else ""
        return f"<li>{name}: {_each('calm_good')}{again}</li>"
    if outcome.end is End.UNFINISHED:
        return f"<li>{name}: {_each('calm_waits')}</li>"
    style = "quiet" if calm.is_sound else "bad"
    why = _found(calm.finding or calm.why)
    return f"<li class={style}>{name}: {_ended(outcome.words)}: {why}</li>"


def _check(check: Check) -> str:
    key = "check_may" if not check.is_sure else "check_between" if check.behind else "check_sure"
    return _each(key, steps=", ".join(check.steps), behind=check.behind)


def _unnoticed(case: Case, count: int, found: Sequence[Check] | None) -> str:
    what = "; ".join(map(_found, case.outcome.untrue))
    befell = _found(f"{case.scenario.name}: {fault_said(case.fault)}; {case.instant.name}")
    checks = "; ".join(map(_check, found or ()))
    check = checks or _each("check_untried" if found is None else "check_none")
    like = _each("runs_like_it", count=count)
    return f"<li>{what}<br>{check}<br><span class=quiet>{befell} ({like})</span></li>"


def _unmended(case: Case, count: int) -> str:
    acts = case.outcome.acts
    what = _each("never_ready") if acts is None else _each("acts", acts=acts)
    befell = _found(f"{case.scenario.name}: {fault_said(case.fault)}; {case.instant.name}")
    return f"<li>{what}<br><span class=quiet>{befell} ({_each('runs_like_it', count=count)})</span></li>"


def _breach(breach: Breach, plant: Path | None) -> str:
    name, sentence = breach.run.outcome.broken or ("", "")
    lines = "\n".join(map(escape, breach.result.lines[-40:]))
    return (
        f"<h3 class=bad>{escape(breach.scenario.name)}: {_found(rules().get(name, ''))}</h3>"
        f"<p>{_found(sentence)}<br>"
        f"{_found(f'{breach.befell}; {breach.instant.name}')} "
        f"({_each('runs_like_it', count=breach.count)})</p><pre>{lines}</pre>{_moment(breach.moment)}"
        f"<p>{_each('test')}</p><pre>{escape(as_tests([breach], plant))}</pre>"
    )


def _moment(moment: Moment) -> str:
    """The tree when it broke, in every language, then the devices as they truly were."""
    trees = (f"<pre lang={each}>{escape(_outline(moment, words(each)))}</pre>" for each in LANGUAGES)
    tree = f"<h4>{_each('tree')}</h4>{''.join(trees)}" if moment.tree else ""
    facts = "".join(f"<li>{escape(name)}: {escape(true)}</li>" for name, true in moment.facts.items() if true)
    return f"{tree}<h4>{_each('twin')}</h4>{as_svg(moment)}<ul>{facts}</ul>"


def _outline(moment: Moment, language: Words) -> str:
    shown = ("name", "feedback")
    rows = [{**row, **{key: language.say(row[key] or "") for key in shown}} for row in folded(moment.tree)]
    return outline(rows, statuses=True)


def _table(key: RecipeKey, rows: dict[str, Row]) -> str:
    heads = "".join(f"<th>{_each(head)}</th>" for head in HEADS)
    body = "".join(f"<tr>{''.join(_cells(kind, row))}</tr>" for kind, row in rows.items())
    turns = "".join(_turns(kind, *each) for kind, row in rows.items() for each in row.turns.items())
    more = f"<details><summary>{_each('turns')}</summary><ul>{turns}</ul></details>" if turns else ""
    table = f"<div class=wide><table><tr>{heads}</tr>{body}</table></div>"
    return f"<h2>{escape(': '.join(key))}</h2>{table}{more}"


def _turns(kind: str, target: str, turns: Sequence[tuple[Instant, str]]) -> str:
    steps = "".join(f"<li>{_found(instant.name)}: {_ended(end)}</li>" for instant, end in turns)
    return f"<li>{_found(f'{target}: {title(kind)}')}<ol>{steps}</ol></li>"


def _cells(kind: str, row: Row) -> Iterator[str]:
    shown = [row.ends[end.value] for end in SHOWN]
    yield f"<td>{_found(title(kind))}</td>"
    for number in (row.runs, *shown, row.runs - sum(shown), row.unnoticed):
        yield f"<td>{f'{number:,}' if number else ''}</td>"
    yield f"<td class=bad>{row.broken or ''}</td><td>{row.alone / row.runs:.0%}</td>"
    causes = ", ".join(_ended(cause) for cause, _ in row.causes.most_common())
    yield f"<td>{causes}{' *' if row.changes else ''}</td>"


def _each(key: str, **values: Any) -> str:
    """Words of the page in every language."""
    rows = ((each, texts(each, PART)[key]) for each in LANGUAGES)
    return "".join(f"<span lang={each}>{escape(text.format(**values))}</span>" for each, text in rows)


def _ended(text: str) -> str:
    """The end of a task with its cause, or a cause alone, given by the plant's words, in every language."""
    said = (
        (each, ": ".join(words(each).ends.get(name, name) for name in text.split(": "))) for each in LANGUAGES
    )
    return "".join(f"<span lang={language}>{escape(end)}</span>" for language, end in said)


def _found(text: str) -> str:
    """A finding, given in English, in every language."""
    return "".join(f"<span lang={each}>{escape(findings(each)(text))}</span>" for each in LANGUAGES)
