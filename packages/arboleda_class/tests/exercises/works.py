"""Works of exercises that are right and wrong, for the test of the judge, and their table.

`python -m packages.arboleda_class.tests.exercises.works`, in the project's folder, judges them all; with the
names of exercises, theirs.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import Any

import yaml

from arboleda_class.exercises.exercise import catalog, exercise
from arboleda_class.exercises.judge import Judge, Verdict
from arboleda_class.exercises.work import SHEET

WORKS = Path(__file__).parent / "works"


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Sample of a work: whether it is right, what it is about, and its files."""

    exercise: str
    right: bool
    about: str
    files: dict[str, bytes]

    def __str__(self) -> str:
        return f"{self.exercise}: {'right' if self.right else 'wrong'}: {self.about}"

    def judged(self) -> Verdict:
        """The verdict of the judge, in this process."""
        return Judge(exercise(self.exercise), self.files).judge()


def samples(*names: str) -> Iterator[Sample]:
    """The samples of these exercises, of all if none is named; what one starts with is a wrong one."""
    for name in names or catalog():
        said: dict[str, Any] = yaml.safe_load((WORKS / f"{name}.yaml").read_text("utf-8"))
        start = {each: exercise(name).start[each] for each in exercise(name).yours}
        model = {each: text.encode() for each, text in said["right"][0]["files"].items()}
        yield Sample(exercise=name, right=False, about="as it starts", files=start)
        for right in (True, False):
            for each in said["right" if right else "wrong"]:
                own = {called: text.encode() for called, text in each.get("files", {}).items()}
                files = {**model, **own}
                for old, new in each.get("edits", ()):
                    files = _edited(files, old, new)
                yield Sample(exercise=name, right=right, about=each["about"], files=files)


def two(name: str) -> list[Sample]:
    """The first right work of an exercise, and the first wrong one that is not its beginning."""
    known = list(samples(name))
    return [next(each for each in known if each.right), [each for each in known if not each.right][1]]


def handed_in(folder: Path, name: str, student: str) -> Path:
    """The first right work of an exercise as a folder of a student."""
    made = folder / student / name
    made.mkdir(parents=True)
    (made / SHEET).write_text(f"exercise: {name}\nstudent: {student}\n", "utf-8")
    for called, content in two(name)[0].files.items():
        (made / called).write_bytes(content)
    return made


def _edited(files: dict[str, bytes], old: str, new: str) -> dict[str, bytes]:
    holding = [name for name, content in files.items() if old.encode() in content]
    assert len(holding) == 1, f"one file holds this: {old}; {holding}"
    [name] = holding
    assert files[name].count(old.encode()) == 1, f"{name} holds this not once: {old}"
    return {**files, name: files[name].replace(old.encode(), new.encode())}


def main(names: list[str]) -> int:
    """Print a line for each work; the number of those that are not judged as they are."""
    wrong = 0
    for each in samples(*names):
        before = process_time()
        verdict = each.judged()
        wrong += verdict.passes != each.right
        mark = "    " if verdict.passes == each.right else "BAD "
        why = (
            ""
            if verdict.passes
            else f" | {verdict.findings[0].says['en']}: {verdict.findings[0].evidence[:140]}"
        )
        print(f"{mark}{process_time() - before:5.1f} s {verdict.runs:4} runs  {each}{why}", flush=True)
    print(f"{wrong} judged otherwise than they are")
    return wrong


if __name__ == "__main__":
    sys.exit(bool(main(sys.argv[1:])))
