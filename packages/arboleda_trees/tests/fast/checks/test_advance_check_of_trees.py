"""Findings of `check` in a tree as XML that it does not run, with their places."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.plants import read
from tests.unit.plant_check.test_advance_check import PLANT

from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import advance_check

TREE = """<root BTCPP_format="4" main_tree_to_execute="Main"><BehaviorTree ID="Main"><Sequence>
{body}
</Sequence></BehaviorTree>
{more}</root>
"""
MODEL = '<TreeNodesModel><SubTree ID="Main">{}</SubTree></TreeNodesModel>'
ENDS = MODEL.format('<MetadataFields><Metadata ends_with="{}"/></MetadataFields>')


def take(at: str) -> str:
    return f'<loader_visit target="{at}"><jaw_close width_mm="20" force_n="20"/></loader_visit>'


def put(at: str) -> str:
    return f'<loader_visit target="{at}"><jaw_open/></loader_visit>'


OPEN, CLOSE, HOME, READ = "<reader_open/>", "<reader_close/>", "<loader_home/>", "<reader_read/>"
ASK = '<reader_read answer="{seen}"/>'
INTO = take("rack") + OPEN + put("drawer") + CLOSE
OUT = OPEN + take("drawer") + put("bin") + CLOSE + HOME
NONE = "<AlwaysSuccess/>"


def row(*parts: str) -> str:
    return f"<Sequence>{''.join(parts)}</Sequence>"


def if_clear(then: str, otherwise: str) -> str:
    test = "<ScriptCondition code=\"seen == 'clear'\"/>"
    return f"<IfThenElse>{test}{row(then)}{row(otherwise)}</IfThenElse>"


def written(folder: Path, body: str, more: str = "") -> PlantModel:
    tree = TREE.format(body=body, more=more)
    return read(folder, PLANT.replace("recipes.py", "attempt.xml"), beside={"attempt.xml": tree})


def warned(folder: Path, body: str, more: str = "") -> list[str]:
    """Warnings of `check`; `advised` has what to write."""
    return [
        each.removeprefix(f"{folder / 'attempt.xml'}:").partition("; write ")[0]
        for each in advance_check.warnings(written(folder, body, more))
    ]


def advised(folder: Path, body: str, more: str = "") -> list[str]:
    return [each.partition("; write ")[2] for each in advance_check.warnings(written(folder, body, more))]


ADVICE = {
    "a need": (INTO + OPEN + READ + OUT, "<reader_close/> before"),
    "a part left": (take("rack") + HOME, '<Metadata ends_with="jaw.gripped: true"/> if that is meant'),
    "a part more": (INTO + HOME, '<Metadata ends_with="drawer: 1"/> if that is meant'),
    "a retry": (
        f"<RetryUntilSuccessful num_attempts='1000'>{OPEN}</RetryUntilSuccessful>" + CLOSE,
        '<Timeout msec="60000"> around it',
    ),
}


@pytest.mark.parametrize(("body", "advice"), ADVICE.values(), ids=ADVICE)
def test_a_warning_ends_with_what_to_write_in_a_tree(tmp_path: Path, body: str, advice: str) -> None:
    assert advice in advised(tmp_path, body)


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    "body",
    [
        INTO + ASK + if_clear(OUT, OUT),
        INTO + ASK + if_clear(OPEN, NONE) + if_clear(OUT.removeprefix(OPEN), OUT),
        INTO + f"<RetryUntilSuccessful num_attempts='3'>{READ}</RetryUntilSuccessful>" + OUT,
        f"<Timeout msec='9'><RetryUntilSuccessful num_attempts='-1'>{OPEN}</RetryUntilSuccessful></Timeout>",
        INTO + f"<TryCatch>{READ}{OPEN}</TryCatch>" + OUT,
        f"<Parallel>{OPEN}{take('rack')}</Parallel>" + put("drawer") + OUT,
        f"<Repeat num_cycles='1'>{row(INTO, OUT)}</Repeat>".replace("rack", "nest"),
        INTO + "<reader_tells lid='{lid}'/><reader_open _skipIf=\"lid == 'open'\"/>" + OUT,
        OPEN + '<Fallback><reader_says lid="closed"/><reader_close/></Fallback>' + READ,
        "<reader_tells lid='{lid}'/><reader_open _skipIf=\"lid == 'open'\"/>"
        + "<Fallback><ScriptCondition code=\"lid != 'open'\"/><reader_close/></Fallback>",
    ],
)
def test_nothing_is_said_of_what_can_be_so(tmp_path: Path, body: str) -> None:
    assert warned(tmp_path, body) == []


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        (
            INTO + "\n" + OPEN + "\n" + READ + OUT,
            "4:1: lab: attempt has reader read, which needs lid of reader to be closed, where it is open",
        ),
        (
            CLOSE + take("rack") + "\n" + put("drawer") + OUT,
            "3:1: lab: attempt has loader go to drawer where lid of reader is closed; it has to be open",
        ),
        (
            take("rack") + OPEN + f'<loader_visit target="drawer">{row("<jaw_open/>", CLOSE)}</loader_visit>',
            "2:148: lab: attempt has reader close while loader stands at drawer",
        ),
        (
            take("nest") + put("bin") + "\n" + take("nest") + put("bin") + HOME,
            "3:29: lab: attempt has jaw take hold of a part at nest, where nothing can be",
        ),
        (
            INTO + f"\n<RetryUntilSuccessful num_attempts='-1'>{READ}</RetryUntilSuccessful>" + OUT,
            "3:1: lab: attempt tries reader_read again without end; a task that cannot be done never ends so",
        ),
        (
            f"<RetryUntilSuccessful num_attempts='1000'>{OPEN}</RetryUntilSuccessful>" + CLOSE,
            "2:1: lab: attempt tries reader_open again 1,000 times; a task that cannot be done never ends so",
        ),
        (take("rack") + HOME, "1:52: lab: attempt ends with a part that jaw still holds"),
        (
            "<jaw_open/>" + INTO + HOME,
            "1:52: lab: attempt ends with 1 more at drawer of reader than it began with",
        ),
        (INTO + HOME, "1:52: lab: attempt ends with 1 more at drawer of reader than it began with"),
        (
            INTO + ASK + if_clear(OUT, OUT.replace(CLOSE, "")),
            "1:52: lab: attempt ends with reader lid closed and open, by which way it goes",
        ),
        (
            f"<Parallel>{take('rack')}\n{row(OPEN, READ)}</Parallel>{put('bin')}",
            "3:25: lab: attempt has reader read, which needs lid of reader to be closed, where it is open",
        ),
        (
            f"<Parallel>{OPEN}{take('rack')}</Parallel>\n{READ}{put('bin')}",
            "3:1: lab: attempt has reader read, which needs lid of reader to be closed, where it is open",
        ),
    ],
)
def test_it_says_what_is_wrong_for_certain(tmp_path: Path, body: str, sentence: str) -> None:
    found = warned(tmp_path, body)
    assert any(each.startswith(sentence) for each in found), found


def test_a_subtree_is_followed_with_the_values_that_it_is_given(tmp_path: Path) -> None:
    turn = """<BehaviorTree ID="Turn"><Switch2 variable="{lid}" case_1="open" case_2="closed">
<reader_open/><reader_close/><AlwaysFailure/></Switch2></BehaviorTree>"""
    given = '<SubTree ID="Turn" lid="{}"/>'
    assert warned(tmp_path, given.format("closed") + READ, turn) == []
    (found,) = warned(tmp_path, given.format("open") + READ, turn)
    assert found.endswith("which needs lid of reader to be closed, where it is open")


def test_what_a_tree_says_of_its_end_counts(tmp_path: Path) -> None:
    left = ENDS.format("drawer: 1; reader.lid: open")
    assert warned(tmp_path, INTO + OPEN + HOME, left) == []
    (found,) = warned(tmp_path, INTO + HOME, left)
    assert found.endswith("ends with reader.lid closed, and says that it ends with open")


def test_the_ends_of_a_tree_are_those_of_all_its_ways(tmp_path: Path) -> None:
    plant = written(tmp_path, INTO + ASK + if_clear(OUT, OUT) + OPEN)
    (found,) = advance_check.ends(plant)
    left = "jaw.gripped false, reader.lid open, 1 fewer at rack, 1 more at bin, loader at home"
    assert found == f"lab: attempt ends with {left}"


BACK = """
from arboleda.recipes import Target, node

@node("BringsBackTo")
def brings_back_to(cell, target=Target()):
    cell.device("loader").brings_back_to(target)
    return cell.wait(0)
"""


def test_a_node_in_python_names_where_parts_are_brought_back_to(tmp_path: Path) -> None:
    early = INTO + OPEN + take("drawer") + CLOSE + put("bin") + HOME
    (found,) = warned(tmp_path, early)
    assert "with a part that goes back to drawer after a failure" in found
    (tmp_path / "nodes.py").write_text(BACK, "utf-8")
    plant = PLANT.replace("recipes.py", "nodes.py, attempt.xml")
    tree = TREE.format(body=f'<BringsBackTo target="bin"/>{early}', more="")
    assert advance_check.warnings(read(tmp_path, plant, beside={"attempt.xml": tree})) == ()
