"""Workbooks of the playground: lessons, exercises and plants with their texts, as JSON files of its site.

A lesson is a page of docs/tutorial, and the program of its name in examples/ with the plant that it reads, or
else the first plant of examples/ that the page names. How its program is called stands on the page.
"""

from __future__ import annotations

import json
import posixpath
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import markdown2
from docs_links import LANGUAGE, LINK

from arboleda.web.languages import LANGUAGES, texts
from arboleda_class.exercises.command import effort
from arboleda_class.exercises.exercise import PLANT, catalog
from arboleda_class.playground import plants
from arboleda_class.playground.markup import PlayWords

ROOT = Path(__file__).resolve().parents[1]
PAGES, EXAMPLES = ROOT / "docs/tutorial", ROOT / "examples"
EXTRAS = ["tables", "fenced-code-blocks"]
CALL = r"^\$ \.venv/bin/python examples/{}\.py ?(.*)$"
IMPORTED = re.compile(r'import_module\("(\w+)"\)')
OF_A_PLANT = re.compile(r"examples/[\w/]+\.yaml")
NOT_HERE = {"07_ros2_cell": "needs_ros", "09_mqtt_board": "needs_sockets", "10_plant": "needs_sockets"}
"""Lessons whose program cannot run in a tab, and the word that says why."""
BY_HAND = {"14_break_it": "by_hand", "15_read_a_record": "back_by_slider"}
"""Lessons whose program starts a plant of its own, in whose place a person has the plant of the tab; the word
for that."""
READ_PLANT = re.compile(r'"plants" / "([\w.]+)"')
Book = dict[str, Any]


def write(folder: Path) -> None:
    """Write all workbooks, and `index.json` with their titles and the words of the page."""
    folder.mkdir()
    rows = []
    for book in (*lessons(), *exercises(), *shipped()):
        content = json.dumps(book, ensure_ascii=False)
        folder.joinpath(f"{book['kind']}-{book['name']}.json").write_text(content, "utf-8")
        rows.append({key: book[key] for key in ("kind", "name", "title")})
    words = {language: texts(language, "workbook") for language in LANGUAGES}
    index = json.dumps({"books": rows, "words": words}, ensure_ascii=False)
    folder.joinpath("index.json").write_text(index, "utf-8")


def lessons() -> Iterator[Book]:
    """The lessons of the tutorial, one after the other."""
    for page in sorted(PAGES.glob("[0-9]*.md")):
        if page.suffixes == [".md"]:
            yield _lesson(page.stem)


def exercises() -> Iterator[Book]:
    """The exercises, the easiest first."""
    for each in catalog().values():
        yield {
            "kind": "exercise",
            "name": each.name,
            "title": {language: f"{each.number}. {each.title[language]}" for language in LANGUAGES},
            "text": {
                language: _html(f"{effort(each, language)}\n\n{each.task[language]}")
                for language in LANGUAGES
            },
            "hints": [{language: _html(hint[language]) for language in LANGUAGES} for hint in each.hints],
            "files": {name: content.decode("utf-8") for name, content in each.start.items()},
            "yours": list(each.yours),
            "plant": PLANT,
            "record": each.record is not None,
        }


def shipped() -> Iterator[Book]:
    """The plants of the playground, to be changed; the page of an example is the text."""
    for name in plants.FILES:
        plant, files = plants.texts(name)
        page = ROOT / "docs/examples" / f"{name}.md"
        yield {
            "kind": "plant",
            "name": name,
            "title": {language: PlayWords(language).plant(name) for language in LANGUAGES},
            "text": _pages(page) if page.exists() else dict.fromkeys(LANGUAGES, ""),
            "files": files,
            "yours": list(files),
            "plant": plant,
        }


def _lesson(name: str) -> Book:
    text = PAGES.joinpath(f"{name}.md").read_text("utf-8")
    made: Book = {"kind": "lesson", "name": name, "text": _pages(PAGES / f"{name}.md")}
    made["title"] = {each: _first_line(PAGES / _named(name, each)) for each in LANGUAGES}
    made["elsewhere"] = NOT_HERE.get(name, "")
    program, named = EXAMPLES / f"{name}.py", OF_A_PLANT.search(text)
    if program.exists() and name not in BY_HAND:
        called = re.search(CALL.format(name), text, re.MULTILINE)
        made |= {"files": _with_imported(name), "program": program.name}
        made["arguments"] = called[1] if called else ""
        if read := READ_PLANT.search(program.read_text("utf-8")):
            plant, files = plants.texts_of(EXAMPLES / "plants" / read[1])
            folder = (
                "" if "/" in plant else "plants/"
            )  # one that uses files beside its folder names it itself
            made["plant"] = f"{folder}{plant}"
            made["files"] |= {f"{folder}{file}": text for file, text in files.items()}
    elif named:
        made["plant"], made["files"] = plants.texts_of(ROOT / named[0])
        made["note"] = BY_HAND.get(name, "")
    else:
        raise SystemExit(f"workbooks: lesson {name} has no program in examples/, and names no plant there")
    return made | {"yours": list(made["files"])}


def _with_imported(name: str) -> dict[str, str]:
    """The texts of a program, and of those of other lessons that it imports."""
    found: dict[str, str] = {}
    open_names = [name]
    while open_names:
        each = open_names.pop()
        found[f"{each}.py"] = EXAMPLES.joinpath(f"{each}.py").read_text("utf-8")
        open_names += [name for name in IMPORTED.findall(found[f"{each}.py"]) if f"{name}.py" not in found]
    return found


def _named(name: str, language: str) -> str:
    return f"{name}.md" if language == LANGUAGES[0] else f"{name}.{language}.md"


def _first_line(page: Path) -> str:
    return page.read_text("utf-8").splitlines()[0].removeprefix("# ")


def _pages(page: Path) -> dict[str, str]:
    """A page of the documentation as HTML, by language."""
    found = {language: page.with_name(_named(page.stem, language)) for language in LANGUAGES}
    return {language: _html(_on_site(each)) for language, each in found.items()}


def _on_site(page: Path) -> str:
    """A page with links that make sense in the playground: those to lessons; others are text and path."""

    def link(found: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(page.parent.relative_to(ROOT).as_posix(), found[2]))
        lesson = Path(target).name.split(".")[0]
        if (PAGES / f"{lesson}.md").exists() and lesson[0].isdigit():
            return f"[{found[1]}](workbook.html?lesson={lesson})"
        return f"{found[1]} (`{target}`)"

    text = LANGUAGE.sub("", page.read_text("utf-8"))
    return LINK.sub(link, re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text))  # pictures: the plant itself is beside


def _html(markdown: str) -> str:
    return str(markdown2.markdown(markdown, extras=EXTRAS))
