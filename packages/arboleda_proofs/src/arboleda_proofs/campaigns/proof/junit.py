"""A proof as JUnit XML, which servers of continuous integration show: a case for each kind of fault."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree as Xml

from .calm import Calm
from .outcome import End
from .proof_tally import ProofTally, RecipeKey, Row
from .pytest_file import Breach

CONTROL = {number: None for number in range(32) if chr(number) not in "\t\n"}  # XML has none of them


def as_junit(calm: Sequence[Calm], tally: ProofTally, breaches: Sequence[Breach]) -> str:
    """The content of the file; what nobody notices stands in the output of its case."""
    root = Xml.Element("testsuites", name="arboleda prove")
    table = tally.table()
    for key in dict.fromkeys([*((each.scenario.cell, each.scenario.recipe) for each in calm), *table]):
        suite = Xml.SubElement(root, "testsuite", name=f"{key[0]}: {key[1]}")
        for each in calm:
            if (each.scenario.cell, each.scenario.recipe) == key:
                _calm_case(suite, key, each)
        for kind, row in table.get(key, {}).items():
            _fault_case(suite, key, kind, row, [each for each in breaches if _is_of(each, key, kind)])
        suite.set("tests", str(len(suite)))
        suite.set("failures", str(len(suite.findall("testcase/failure"))))
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _is_of(breach: Breach, key: RecipeKey, kind: str) -> bool:
    return (breach.scenario.cell, breach.scenario.recipe, breach.fault.kind) == (*key, kind)


def _calm_case(suite: Xml.Element, key: RecipeKey, calm: Calm) -> None:
    case = _case(suite, key, f"without faults: {calm.scenario.name}")
    outcome = calm.run.outcome
    if calm.is_sound:
        return
    if outcome.end is End.UNFINISHED and outcome.broken is None:
        Xml.SubElement(case, "skipped", message="alone it never ends, it waits for what others do")
        return
    why = ": ".join(outcome.broken) if outcome.broken else f"{outcome.words}: {calm.why}"
    Xml.SubElement(case, "failure", message=_clean(why))


def _fault_case(suite: Xml.Element, key: RecipeKey, kind: str, row: Row, breaches: Sequence[Breach]) -> None:
    case = _case(suite, key, kind)
    if row.broken:
        failure = Xml.SubElement(
            case, "failure", message=f"{row.broken} of {row.runs} runs break an invariant"
        )
        failure.text = _clean("\n".join(map(_failure_text, breaches)))
    ends = ", ".join(f"{count} {end}" for end, count in row.ends.most_common())
    summary = f"{row.runs} runs: {ends}; {row.alone} ready again without a person"
    unnoticed = f"; {row.unnoticed} done, and nobody notices that not all is so" if row.unnoticed else ""
    Xml.SubElement(case, "system-out").text = summary + unnoticed


def _failure_text(breach: Breach) -> str:
    name, sentence = breach.run.outcome.broken or ("", "")
    return "\n".join([f"{name}: {sentence}", breach.instant.name, *breach.result.lines[-20:]])


def _case(suite: Xml.Element, key: RecipeKey, name: str) -> Xml.Element:
    return Xml.SubElement(suite, "testcase", classname=f"{key[0]}.{key[1]}", name=_clean(name))


def _clean(text: str) -> str:
    return text.translate(CONTROL)
