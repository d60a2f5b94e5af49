"""Judge of exercises: the plant of a student against trials and a proof; texts of files do not matter."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from arboleda.drivers import plain, shown
from arboleda.extension import ArboledaError, ConfigError
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.plant_file.yaml_marks import YamlFault, plain_value
from arboleda_proofs.campaigns.plants import ELSEWHERE, Plant
from arboleda_proofs.campaigns.proof.breaches import breaches_of
from arboleda_proofs.campaigns.proof.calm import Calm, calm_runs
from arboleda_proofs.campaigns.proof.forks import run_on
from arboleda_proofs.campaigns.proof.outcome import IS_DONE, End
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.proof_tally import Case, ProofTally
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.proof.stage import Stage
from arboleda_proofs.simulator.faults import KINDS, Fault

from .exercise import PLANT, Exercise, Proving, Text, TimedFault, Trial
from .trial_run import Course, run_trial
from .wording import fault_is, in_english, task_is, task_is_to

LAST = 30  # lines of a story
SHORT = (" asked ", " FAULT ", " fault over ", " task ", " carries out ", " cell ")
LONGEST = 600  # characters of a sentence
MOST = 3  # sentences on one trial
IS_A_PLANT: Text = {"en": "The files are a plant", "es": "Los archivos son una planta"}
STAYS: Text = {"en": "The rest of the plant stays as it is", "es": "El resto de la planta queda como está"}
DECLARES: Text = {
    "en": "The recipe says what is so at its end",
    "es": "La receta dice qué se cumple al final",
}
HOLDS: Text = {
    "en": "`prove` finds no single fault that breaks the recipe",
    "es": "`prove` no encuentra ningún fallo que rompa la receta",
}
MakePlant = Callable[..., Any]
Again = Callable[[MakePlant], object]
Play = Callable[[Plant, Again], object]
Progress = Callable[[int], object]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Finding: what was to be so, what was not, a line for each thing, and the last things that happened."""

    says: Text
    evidence: str
    story: tuple[str, ...] = ()


@dataclass(kw_only=True)
class Verdict:
    """Verdict on a work: it passes where there are no `findings`. `questions` and `runs` count its
    questions and the simulated runs; `again` simulates the first finding once more, in a plant that is made
    as its argument says.
    """

    questions: int = 0
    runs: int = 0
    findings: list[Finding] = field(default_factory=list)
    again: Again | None = None

    @property
    def passes(self) -> bool:
        """True if all is as it is to be."""
        return not self.findings

    @property
    def plain(self) -> dict[str, Any]:
        """The verdict for JSON."""
        findings = [
            {"says": dict(each.says), "seen": each.evidence, "story": list(each.story)}
            for each in self.findings
        ]
        return {"passes": self.passes, "asked": self.questions, "runs": self.runs, "findings": findings}


class Judge:
    """Judge of one work: `files` are those of the student, by name; Python in them is run.

    `progress` gets the number of simulated runs, again and again; `exercise.runs` is about their end.
    """

    def __init__(
        self, exercise: Exercise, files: Mapping[str, bytes], *, progress: Progress = lambda _: None
    ) -> None:
        self._exercise = exercise
        self._progress = progress
        self._theirs = {name: files[name] for name in exercise.yours if name in files}
        self.verdict = Verdict()

    def judge(self, *, play: Play | None = None) -> Verdict:
        """The verdict; `play` gets the student's plant, and the first thing that is not so as `again` of a
        Verdict, while the files are there."""
        with TemporaryDirectory(prefix="arboleda-") as made:
            folder = Path(made)
            for name, content in {**self._exercise.start, **self._theirs}.items():
                (folder / name).write_bytes(content)
            try:
                self._judge(folder, play)
            except ConfigError as error:
                text = "; ".join(each.replace(f"{folder}/", "") for each in error.problems[:3])
                self._find(Finding(says=IS_A_PLANT, evidence=plain(text, LONGEST)))
        return self.verdict

    def _judge(self, folder: Path, play: Play | None) -> None:
        self.verdict.questions += 1
        self._changed()
        if self.verdict.findings:
            return  # what it asks may not be there
        model, files = loader.load_with_files(folder / PLANT)
        for recipe, ends in self._exercise.declares.items():
            self._declared(model, recipe, ends)
        for trial in self._exercise.trials:
            self._try(model, trial)
        for proving in self._exercise.proving:
            if not self.verdict.findings:
                self._prove(model, proving)
        if play is not None and self.verdict.again is not None:
            play(Plant(declared=model, files=files), self.verdict.again)

    def _find(self, finding: Finding, again: Again | None = None) -> None:
        if not self.verdict.findings:
            self.verdict.again = again
        story = tuple(map(in_english, finding.story))
        self.verdict.findings.append(replace(finding, evidence=in_english(finding.evidence), story=story))

    def _changed(self) -> None:
        """Find what of the plant file was changed that is no part of the exercise."""
        if PLANT not in self._theirs:
            return
        try:
            before, now = map(plain_value, (self._exercise.start[PLANT], self._theirs[PLANT]))
        except YamlFault:
            return  # the plant file's own check says what is wrong
        for place in self._exercise.keeps:
            if _at(before, place) != _at(now, place):
                self._find(Finding(says=STAYS, evidence=f"{place} of {PLANT} was changed"))

    def _declared(self, model: PlantModel, recipe: str, ends: Mapping[str, Any]) -> None:
        self.verdict.questions += 1
        declared_ends = [
            dict(each.end_of({})) for cell in model.cells for each in cell.recipes if each.name == recipe
        ]
        for what, value in ends.items():
            if not any(each.get(what) == value for each in declared_ends):
                evidence = f"ends_with of {recipe} does not say that {what} is {shown(value)}"
                self._find(Finding(says=DECLARES, evidence=evidence))

    def _try(self, model: PlantModel, trial: Trial) -> None:
        self.verdict.questions += 1
        faults: Sequence[TimedFault] = trial.faults
        if trial.faults_in:
            try:
                faults = _written(self._theirs.get(trial.faults_in, b""), model, trial.faults_in)
            except ArboledaError as error:
                self._find(Finding(says=trial.says, evidence=str(error)))
                return
        course = self._run(model, trial, faults)
        if trial.faults_in and self._exercise.record is not None:
            recorded = self._run(model, self._exercise.record, self._exercise.record.faults)
            course.objections += _others(recorded, course)
        if course.objections:
            evidence = "\n".join(plain(each, LONGEST) for each in course.objections[:MOST])
            finding = Finding(says=trial.says, evidence=evidence, story=tuple(course.story[-LAST:]))
            self._find(finding, lambda make: run_trial(model, trial, faults, make_plant=make))

    def _run(self, model: PlantModel, trial: Trial, faults: Sequence[TimedFault]) -> Course:
        self._count(1)
        return run_trial(model, trial, faults)

    def _count(self, runs: int) -> None:
        self.verdict.runs += runs
        self._progress(self.verdict.runs)

    def _prove(self, model: PlantModel, proving: Proving) -> None:
        self.verdict.questions += 1
        boards = model.on_boards(*ELSEWHERE)
        calm = tuple(calm_runs(boards, scenarios(boards, [proving.recipe])))
        if not calm:
            self._find(Finding(says=HOLDS, evidence=f"no cell offers {proving.recipe}"))
        for each in calm:
            if not each.is_sound and not _was_to_fail(each):
                broken = ": ".join(each.run.outcome.broken or ())
                why = broken or f"{each.run.outcome.words}: {each.finding or each.why}"
                self._find(
                    Finding(
                        says=HOLDS, evidence=plain(f"{each.scenario.name}, without any fault: {why}", LONGEST)
                    )
                )
                return
        calm = tuple(each for each in calm if each.is_sound)
        proof = Proof(model=boards, calm=calm, kinds=proving.kinds)
        tally = _tally(proof, proving.runs, lambda: self._count(1))
        for breach in breaches_of(tally)[:1]:
            name, sentence = breach.run.outcome.broken or ("", "")
            befell = f"{fault_is(breach.fault)}, {breach.instant.name}"
            evidence = f"{breach.scenario.name}: {befell}: {name}: {sentence}"
            finding = Finding(
                says=HOLDS,
                evidence=plain(evidence, LONGEST),
                story=tuple(_short(breach.result.lines)[-LAST:]),
            )
            at = next(each for each in calm if each.scenario == breach.scenario)
            self._find(finding, partial(_recorded, boards, at, breach.fault))
        wrong = next(_wrong_ends(tally, proving), None)
        if wrong is not None and not self.verdict.findings:
            case, evidence = wrong
            finding = Finding(says=HOLDS, evidence=plain(evidence, LONGEST))
            self._find(finding, partial(_recorded, boards, calm[case.row], case.fault))


def _was_to_fail(calm: Calm) -> bool:
    """True if the recipe has the task fail by itself, with `cell.fail`: trials know whether that is right."""
    outcome = calm.run.outcome
    return outcome.end is End.FAILED and outcome.cause == Reason.REJECTED.value and outcome.broken is None


def _recorded(model: PlantModel, calm: Calm, fault: Fault, make_plant: MakePlant) -> None:
    run_on(Stage(model, calm.scenario, keep=True, make_plant=make_plant), calm, fault)


def _short(lines: Sequence[str]) -> list[str]:
    """Those of the lines of a timeline that say what was asked, what befell the plant, and what was done."""
    return [each for each in lines if any(word in each for word in SHORT)]


def _tally(proof: Proof, runs: int, tick: Callable[[], None]) -> ProofTally:
    """The outcome of so many runs or a few more, the beginnings of steps first."""
    tally = ProofTally(proof=proof)
    for number in range(len(proof.portions)):
        if tally.runs >= runs:
            break
        tally.proved[number] = proof.run(number, tick=tick)
    return tally


def _wrong_ends(tally: ProofTally, proving: Proving) -> Iterator[tuple[Case, str]]:
    """Cases in which a task ends otherwise than it may, or is done and nobody notices what is not so."""
    for case in tally.cases():
        allowed = proving.ends.get(case.fault.kind)
        what = f"{case.scenario.name}: {fault_is(case.fault)}, {case.instant.name}"
        outcome = case.outcome
        why = f": {outcome.cause}" if outcome.cause else ""
        if allowed is not None and outcome.end.value not in allowed:
            yield case, f"{what}: {task_is_to('the task', allowed)}; {task_is('it', outcome.end.value)}{why}"
        if case.fault.kind in proving.noticed and outcome.end in IS_DONE and outcome.untrue:
            yield case, f"{what}: the task is called done, but {'; '.join(outcome.untrue)}"


def _others(recorded: Course, course: Course) -> Iterator[str]:
    """In what a course is another one than that of the record."""
    if recorded.ends != course.ends:
        now, before = ", ".join(course.ends), ", ".join(recorded.ends)
        yield f"with these faults the task ends as {now}; in the record: {before}"
    elif recorded.sentences != course.sentences:
        now, before = ", ".join(course.sentences), ", ".join(recorded.sentences)
        yield f"with these faults the plant says {now}; in the record: {before}"
    elif recorded.acts != course.acts:
        now, before = ", ".join(course.acts), ", ".join(recorded.acts)
        yield f"with these faults what is done is {now}; in the record: {before}"


def _written(content: bytes, model: PlantModel, name: str) -> list[TimedFault]:
    """The faults that a student has written; ArboledaError with what is wrong."""
    try:
        rows: Any = plain_value(content)
        faults = [Fault(**{key: _number(value) for key, value in row.items()}) for row in rows["faults"]]
    except (YamlFault, KeyError, TypeError, AttributeError) as error:
        raise ArboledaError(
            f"{name} is to have a list of faults: `- {{kind: reboot, target: loader, at: 3.5}}`"
        ) from error
    for each in faults:
        if each.kind not in KINDS:
            raise ArboledaError(f"{name}: there is no fault {plain(str(each.kind), 40)}")
        objection = KINDS[each.kind].objection(each, model.on_boards(*ELSEWHERE))
        if objection is not None:
            raise ArboledaError(f"{name}: {objection}")
    return [TimedFault(fault=each) for each in faults]


def _number(value: object) -> Any:
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def _at(data: Any, place: str) -> Any:
    """The value at a place of a plant file, with dots between its keys; None where there is none."""
    for key in place.split("."):
        data = data.get(key) if isinstance(data, dict) else None
    return data
