"""The report as one HTML file that needs no network: every language in it, one of them shown."""

from __future__ import annotations

import base64
import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from html import escape
from importlib import resources
from typing import Any

from arboleda.dashboard.findings import findings
from arboleda.drawing.folding import folded
from arboleda.drawing.words import outline
from arboleda.extension import Sentence, Words, words
from arboleda.model.plant_model import PlantModel
from arboleda.web.languages import FIRST, LANGUAGES, texts
from arboleda_proofs.playback.cause import Cause
from arboleda_proofs.playback.incident import Incident

from .facts import facts
from .scene import scene
from .tries import ForkTrial

SLOT = re.compile("__([A-Z]+)__")


@dataclass(frozen=True, kw_only=True)
class Report:
    """The contents of a report; `command` executes the record again up to the end of the task. Of a task that
    has not failed there is no `cause`, and nothing that would have changed it."""

    incident: Incident
    cause: Cause | None
    model: PlantModel
    tries: list[ForkTrial]
    case: str
    command: str


def page(report: Report) -> str:
    """The content of the file."""
    template = resources.files(__package__).joinpath("report.html").read_text("utf-8")
    drawn = scene(report.incident, report.model) if report.cause else None
    told = {"scene": drawn, "facts": facts(report.incident, report.cause)}
    put = {
        "TITLE": escape(texts(FIRST, "report")[_title(report)].format(task=report.incident.task)),
        "HIDDEN": ",".join(f"html[lang={each}] body [lang]:not([lang={each}])" for each in LANGUAGES),
        "NAMES": " / ".join(escape(texts(each, "page")["name"]) for each in LANGUAGES),
        "LANGUAGES": json.dumps(LANGUAGES),
        "BODY": "\n".join(_parts(report, has_twin=drawn is not None)),
        "DATA": json.dumps(told).replace("<", "\\u003c"),
    }
    return SLOT.sub(lambda found: put[found[1]], template)  # in one pass: texts may look like a slot


def _parts(report: Report, *, has_twin: bool) -> Iterator[str]:
    found, cause = report.incident, report.cause
    when = datetime.fromtimestamp(found.unix_ns / 1e9).isoformat(" ", "seconds")
    yield f"<h1>{_each(_title(report), task=found.task)}</h1>"
    yield f"<p class=quiet>{escape(found.text)} · {escape(found.cell)} · {when}</p>"
    if cause is not None:
        yield from _why(found, cause)
    yield from _chapters(found)
    if cause is not None:
        yield from _course(report, has_twin=has_twin)
        yield from _changes(report)
    yield f"<section><h2>{_each('again')}</h2><pre>{escape(report.command)}</pre></section>"
    if cause is not None:
        yield f"<section><h2>{_each('test')}</h2><p class=quiet>{_each('test_note')}</p>"
        yield f"<pre id=test>{escape(report.case)}</pre>"
        yield f"<button id=copy>{_each('copy')}</button> <button id=save>{_each('save')}</button></section>"


def _title(report: Report) -> str:
    """The key of the words in its title."""
    return "title_of_any" if report.cause is None else "title"


def _why(found: Incident, cause: Cause) -> Iterator[str]:
    yield f"<section class=cause><h2>{_each('cause')}</h2><p class=big>{_sentence_spans(cause.sentence)}</p>"
    own = found.failure.sentence if found.failure else ""
    yield f"<p class=quiet>{_each('cause_note')} {_sentence_spans(own)}</p></section>"
    yield f"<section><h2>{_each('evidence')}</h2><ul>{''.join(_evidence(found))}</ul></section>"


def _chapters(found: Incident) -> Iterator[str]:
    """Chapters that packages wrote. A picture is an image, in which no script runs."""
    for each in found.chapters:
        yield f"<section><h2>{escape(each.title)}</h2><p class=quiet>{escape(each.package)}</p>"
        if each.text:
            yield f"<p class=lines>{escape(each.text)}</p>"
        rows = "".join(f"<tr>{''.join(f'<td>{escape(cell)}' for cell in row)}" for row in each.rows)
        yield f"<table>{rows}</table>"
        if each.picture:
            source = f"data:{each.picture_type};base64,{base64.b64encode(each.picture).decode()}"
            yield f'<img src="{source}" alt="{escape(each.title)}">'
        yield "</section>"


def _course(report: Report, *, has_twin: bool) -> Iterator[str]:
    """The last seconds before the failure, and the acts of operators."""
    found = report.incident
    if has_twin:
        yield f"<section><h2>{_each('twin')}</h2><svg id=twin></svg>"
        yield "<p><input id=time type=range min=0 value=0> <output id=at></output> "
        yield f"{_each('before')}</p></section>"
    if found.tree:
        yield f"<section><h2>{_each('tree')}</h2>{_tree(found)}</section>"
    yield f"<section><h2>{_each('messages')}</h2><p class=quiet>{_each('messages_note')}</p>"
    yield from (_messages(found, name) for name in _mine(report))
    acts = "".join(f"<li>{at - _zero(found):+.2f} s {escape(word)}</li>" for at, word in found.acts)
    acts = acts or f"<li>{_each('none')}</li>"
    yield f"</section><section><h2>{_each('acts')}</h2><ul>{acts}</ul></section>"


def _changes(report: Report) -> Iterator[str]:
    yield f"<section><h2>{_each('changed')}</h2><p class=quiet>{_each(_note(report))}</p>"
    yield f"<table>{''.join(_try(each, report) for each in report.tries)}</table></section>"


def _note(report: Report) -> str:
    """The note on the forks: what they show, or that they show nothing."""
    return "changed_note" if report.tries[0].alike else "changed_nothing"


def _zero(found: Incident) -> float:
    return found.failed_at or found.ended_at or 0.0


def _each(key: str, **values: Any) -> str:
    """Words of the report in every language."""
    rows = ((each, texts(each, "report")[key]) for each in LANGUAGES)
    return "".join(_span(language, text.format(**values) if values else text) for language, text in rows)


def _sentence_spans(sentence: Sentence | str) -> str:
    """A sentence of the plant in every language."""
    return "".join(_span(language, words(language).say(sentence)) for language in LANGUAGES)


def _span(language: str, text: str) -> str:
    return f"<span lang={language}>{escape(text)}</span>"


def _mine(report: Report) -> list[str]:
    """The devices of the cell, and the robot that the cause names."""
    cells = [cell for cell in report.model.cells if cell.name == report.incident.cell]
    names = [robot.name for cell in cells for robot in cell.robots]
    blamed = report.cause.robot if report.cause else None
    names += [blamed] if blamed and blamed not in names else []
    return [name for name in names if name in report.incident.messages]


def _evidence(found: Incident) -> Iterator[str]:
    zero = _zero(found)
    for trouble in found.troubles:
        if trouble.ends >= found.began_at:
            lasted = "…" if trouble.seconds == math.inf else f"{trouble.seconds:.1f}"
            cut = f" ({_each('cut')})" if trouble.cut else ""
            what = _each(f"trouble_{trouble.kind}", seconds=lasted)
            yield f"<li>{trouble.at - zero:+.2f} s {escape(trouble.robot)}: {what}{cut}</li>"
    last = found.evidence.last if found.failure else None
    if last is not None:
        late = None if last.accepted_at is None else last.accepted_at - last.at
        how = _each("not_accepted") if late is None else _each("accepted", seconds=late)
        whose = f"{escape(last.robot)}: {_each('sent')} {escape(last.id)}"
        yield f"<li>{last.at - zero:+.2f} s {whose}, {how}</li>"
    for at, seconds in found.absences:
        yield f"<li>{at - zero:+.2f} s: {seconds:.1f} s</li>"
    yield f"<li>{(found.ended_at or zero) - zero:+.2f} s {_each('task_end')}</li>"


def _tree(found: Incident) -> str:
    return "".join(f"<pre lang={each}>{escape(_outline(found, words(each)))}</pre>" for each in LANGUAGES)


def _outline(found: Incident, words: Words) -> str:
    columns = ("name", "feedback")
    rows = [{**row, **{key: words.say(row[key] or "") for key in columns}} for row in folded(found.tree)]
    return outline(rows, statuses=True)


def _messages(found: Incident, name: str) -> str:
    rows = "".join(f"<tr><td>{at - _zero(found):+.2f}<td>{escape(text)}" for at, text in found.messages[name])
    return f"<h3>{escape(name)}</h3><table class=small>{rows}</table>"


def _try(each: ForkTrial, report: Report) -> str:
    what = _each(each.what, value=each.value)
    command = f"{report.command} {each.options}".strip() if each.options else ""
    return f"<tr><td>{what}<td>{_end(each.end)}<td><code>{escape(command)}</code>"


def _end(text: str) -> str:
    """The end of a task in a fork, `failed TASK (id ID): why`, in every language."""
    state, _, rest = text.partition(" ")
    task, mark, why = rest.partition("): ")
    said = ((each, words(each).ends.get(state, state), findings(each)(why)) for each in LANGUAGES)
    return "".join(_span(language, f"{end} {task}{mark}{found}".strip()) for language, end, found in said)
