"""What is found in another language by its English has a twin there: each sentence of these files."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from string import Formatter

import pytest
from tests.packages import PACKAGES

from arboleda.web.languages import FIRST, LANGUAGES, contents

PACKAGE = Path(__file__).parents[2] / "src/arboleda/arboleda"
WORDS = PACKAGE / "web/languages"
SEEING = ("invariants", "recorded", "truth")  # what an invariant saw is said there
OF_BOARDS = PACKAGES["arboleda_boards"]
OF_CLASS = PACKAGES["arboleda_class"]
OF_MAKERS = PACKAGES["arboleda_drivers"]
OF_MAKING = PACKAGES["arboleda_make"]
OF_PROOFS = PACKAGES["arboleda_proofs"]
OF_TREES = PACKAGES["arboleda_trees"]
AT_A_START = {  # of a driver, which `check` says, too
    *("addresses.py", "checks.py", "health.py", "limits.py", "nodes.py", "paths.py", "port.py", "reading.py"),
    *("keys.py", "registers.py", "sent.py", "settings.py", "stream.py", "types.py", "unheard_of.py"),
    "variables.py",
}


def _files(folder: Path, *patterns: str) -> list[Path]:
    """The modules of a folder by these patterns, each of which has some."""
    found = [sorted(folder.glob(each)) for each in patterns]
    assert all(found), f"{folder} has none by one of {patterns}"
    return [file for files in found for file in files]


FILES = (
    *_files(PACKAGE, "plant_file/*.py", "plant_check/*.py", "kinds/*.py"),
    *_files(PACKAGE, "wire/strict.py", "wire/payloads.py", "client/http.py"),
    *_files(PACKAGE, "drivers/*.py"),  # settings, and why there is no link or nothing is sent
    *_files(OF_BOARDS, "conformance/*.py"),
    *_files(OF_CLASS, "exercises/trial_run.py", "playground/*.py"),
    *_files(OF_PROOFS, "campaigns/*.py", "campaigns/proof/*.py", "simulator/findings.py"),
    *_files(OF_PROOFS, *(f"simulator/{folder}/*.py" for folder in SEEING)),
    *_files(OF_TREES, "bt_xml/checking.py", "bt_xml/reading.py", "checks/*.py", "files/*.py"),
    *_files(OF_MAKING, "drafts/*.py", "trying/*.py", "proposals/*.py"),
    *_files(OF_MAKING, *(f"versions/{name}.py" for name in ("change", "desk", "restart"))),
    *(
        file
        for file in _files(OF_MAKERS, "*/*.py")
        if file.parent.name != "virtual" and file.name != "server.py"
    ),
)
RUNNING = [
    file
    for file in FILES
    if {PACKAGE / "drivers", OF_MAKERS} & {*file.parents} and file.name not in AT_A_START
]
WRITING = {"from_above.py", "badge.py", "junit.py", "page.py", "pytest_file.py", "urdf.py"}  # other files
HELPING = {"command.py"}  # in words of cli.yaml
VERBATIM = re.compile(
    r"bold \w+|pylabrobot loop|echo:|(sec|def) arboleda_|state: \{|"
    r"object at 0x|from arboleda|\(\?P<file>|import sys|\^|cell\.\w+\(|becomes\(|def \{\}\(|timeout_s \{\},|"
    r"<(Timeout|Metadata) "
)
OF_LOG = re.compile("%[sd]")
OF_OTHERS = {  # by which errors of PyYAML are known
    "mapping values are not allowed",
    "cannot start any token",
    "unexpected end of stream",
    "did not find expected",
}
OF_CALLS = {  # behind the name of a call, as by its server, and of Python
    *("has not succeeded", "is not there", "was refused"),
    r"got an unexpected keyword argument '(\w+)'",
    r"missing \d+ required (?:positional|keyword-only) arguments?: (.+)",
}
TO_DEVICES = {  # and in examples of a plant file
    "brake release",
    "close popup",
    "close safety popup",
    "gripped: bool, width_mm: number, force_n: number",
    "is in remote control",
    "loaded: bool, charging: bool, battery: number",
    "ns=2;s=Belt.State, nsu=http://maker.example/belt;s=State or ns=2;i=1001",
    "power on",
    "unlock protective stop",
}
# a phrase has a key, the name of a check stays as it is, nobody reads what a mistake in our code raises
NO_SENTENCES = {"Phrase", "Check", "RuntimeError", "TypeError", "JSONDecodeError"}
SENTENCE = re.compile(r"[a-z]{2,}[,;:]? (.*\W)?[a-z]{2,}")  # two words at least


def sentences(node: ast.AST) -> Iterator[tuple[int, str]]:
    """The texts of at least two words in a piece of Python, with {} for each value: line and text."""
    if _is_docstring(node) or (isinstance(node, ast.Call) and _called(node) in NO_SENTENCES):
        return
    if isinstance(node, ast.Assert):
        return
    if isinstance(node, ast.Constant | ast.JoinedStr):
        text = _text(node)
        if (
            SENTENCE.search(text)
            and not OF_LOG.search(text)
            and not VERBATIM.match(text)
            and text not in OF_OTHERS | OF_CALLS | TO_DEVICES
        ):
            yield node.lineno, text
    for each in ast.iter_child_nodes(node):
        if not (isinstance(node, ast.JoinedStr) and isinstance(each, ast.Constant)):
            yield from sentences(each)


def _is_docstring(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _called(call: ast.Call) -> str:
    of = call.func
    return of.attr if isinstance(of, ast.Attribute) else of.id if isinstance(of, ast.Name) else ""


def _text(node: ast.Constant | ast.JoinedStr) -> str:
    if isinstance(node, ast.JoinedStr):
        return "".join(_text(each) if isinstance(each, ast.Constant) else "{}" for each in node.values)
    return " ".join(node.value.split("\n    ")) if isinstance(node.value, str) else ""


def said(language: str) -> set[str]:
    """The sentences that a language has, in English with {} for each value."""
    rows = (*contents(language, "findings")["sentences"], *contents(language, "reasons"))
    return {_unnamed(each) for each in rows}


def _unnamed(template: str) -> str:
    """A template with {} for its values; two beside each other are one, for a hint may follow a value."""
    pieces = Formatter().parse(template)
    return _joined("".join(f"{words}{'' if slot is None else '{}'}" for words, slot, *_ in pieces))


def _joined(text: str) -> str:
    return re.sub(r"(\{\})+", "{}", text)


def _is_said(text: str, known: set[str]) -> bool:
    """True if a text is known, be it one with values already, or one that `format` fills."""
    if _joined(text) in known:
        return True
    try:
        return _unnamed(text) in known
    except ValueError:
        return False


@pytest.mark.sampled(32)
@pytest.mark.parametrize("language", LANGUAGES[1:])
@pytest.mark.parametrize(
    "file",
    [each for each in FILES if each.name not in WRITING | HELPING],
    ids=lambda each: f"{each.parent.stem}-{each.stem}",
)
def test_a_sentence_has_its_twin(file: Path, language: str) -> None:
    known = said(language)
    found = sentences(ast.parse(file.read_text("utf-8")))
    alone = [(line, text) for line, text in found if not _is_said(text, known)]
    assert alone == [], f"say these in {language}/findings.yaml"


@pytest.mark.sampled(2)
@pytest.mark.parametrize("language", LANGUAGES[1:])
@pytest.mark.parametrize("file", RUNNING, ids=lambda each: f"{each.parent.stem}-{each.stem}")
def test_a_plant_that_runs_says_what_its_drivers_say(file: Path, language: str) -> None:
    known = {_unnamed(each) for each in contents(language, "reasons")}
    found = sentences(ast.parse(file.read_text("utf-8")))
    alone = [(line, text) for line, text in found if not _is_said(text, known)]
    assert alone == [], f"say these in {language}/reasons.yaml"


def test_sentences_are_found() -> None:
    python = (
        '"""No docstring."""\ndemand(x, f"it says {word}")\nraise Wrong("no such thing" if x else "fine")\n'
    )
    assert list(sentences(ast.parse(python))) == [(2, "it says {}"), (3, "no such thing")]


@pytest.mark.parametrize("language", [each for each in LANGUAGES if each != FIRST])
def test_no_sentence_is_said_in_two_ways(language: str) -> None:
    """Of two rows with the same English YAML silently takes the last."""
    folders = (WORDS, *(code / "languages" for code in PACKAGES.values()))
    files = [folder / language / f"{part}.yaml" for folder in folders for part in ("findings", "reasons")]
    texts = [file.read_text(encoding="utf-8") for file in files if file.exists()]
    text = "\n".join(each.partition("\nsentences:")[2] or each for each in texts)
    rows = re.findall(r'^ *("(?:[^"\\]|\\.)*"):', text, re.MULTILINE)
    assert len(rows) > 1000
    assert [each for each, count in Counter(rows).items() if count > 1] == []
