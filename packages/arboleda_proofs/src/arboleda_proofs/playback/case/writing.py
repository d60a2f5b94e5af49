"""A case as the file that `arboleda simulate --faults` takes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from arboleda.drivers import plain
from arboleda.extension import ConfigError
from arboleda.plant_file.yaml_marks import LARGEST, MOST_VALUES
from arboleda.recorder.preamble import Beginning
from arboleda.recorder.record_text import moment
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.simulator.faults.kind import NONE
from arboleda_proofs.simulator.scripted_people import Act

from .reading import Case

VALUES = 7  # of a line, at most


def as_yaml(case: Case, beginning: Beginning, name: str) -> str:
    """The content of a file with this case."""
    return "\n".join([*_head(case, beginning, name), *_body(case), ""])


def write(target: Path, content: str) -> None:
    """Write the file; ConfigError if that fails, or if it is longer than the simulator reads."""
    if len(content.encode()) > LARGEST or content.count("\n") * VALUES > MOST_VALUES:
        raise ConfigError((f"{target}: a case of so long a record is too large; choose a task with --task",))
    try:
        target.write_text(content, "utf-8")
    except OSError as error:
        raise ConfigError((f"{target}: cannot be written: {error.strerror}",)) from error


def _head(case: Case, beginning: Beginning, name: str) -> Iterator[str]:
    plant = "" if beginning.shipped else f" --plant {plain(beginning.files.plant, 80)}"
    yield f"# arboleda simulate --faults {plain(name, 80)}{plant}"
    yield f"# From a record, from {moment(case.unix_ns)} on: what people did, and what befell devices as far"
    yield "# as reports show it. A simulation has its own boards, and begins with empty racks."
    if beginning.memory or beginning.kept:
        yield "# The plant remembered something of earlier starts, which is not in here."
    if beginning.rate != 1.0:
        fast = f"Its robots were {beginning.rate:g} times as fast"
        yield f"# {fast}; simulated ones are as fast as the plant file says."


def _body(case: Case) -> Iterator[str]:
    yield f"plant: {_text(case.plant)}"
    yield f"seconds: {_number(case.seconds)}"
    yield "people:" if case.people else "people: []"
    yield from (f"  - {_act(act)}" for act in case.people)
    yield "faults:" if case.faults else "faults: []"
    yield from (f"  - {_fault(fault)}" for fault in case.faults)


def _act(act: Act) -> str:
    what = f"do: {_text(act.words)}" if act.task is None else f"task: {_text(act.task)}"
    return f"{{at: {_number(act.at)}, {what}}}"


def _fault(fault: Fault) -> str:
    kind = KINDS[fault.kind]
    words = [f"kind: {fault.kind}", f"at: {_number(fault.at)}"]
    words += [f"target: {_text(fault.target)}"] if fault.target else []
    words += [f"seconds: {_number(fault.seconds)}"] if kind.seconds != NONE else []
    words += [f"amount: {_number(fault.amount)}"] if kind.amount != NONE else []
    words += [f"word: {_text(fault.word)}"] if fault.word else []
    return f"{{{', '.join(words)}}}"


def _text(text: str) -> str:
    """A text in quotes, as in JSON, which YAML reads."""
    return json.dumps(text, ensure_ascii=False)


def _number(number: float) -> str:
    """A number with at most three decimals, without zeros at its end."""
    return f"{number:.3f}".rstrip("0").rstrip(".")
