"""A verb is added by its row, what the plant does at it, and its words: all that knows verbs has it then."""

from __future__ import annotations

from pathlib import Path

from .copied_tree import CopiedTree

ROW = """    WIPE = "wipe", VerbRow(scopes=_CELLS, arguments=(Argument(name="times", type=int),))
"""
PROCEDURE = """            Verb.WIPE: CellByCell(doing, check=not_holdable, do=hold),
"""
WORDS = """    Verb.WIPE: VerbWords(
        label="Wipe it",
        page="Has somebody wipe the cell.",
        brief="Wipe a cell.",
        does="has a cell wiped",
        refused="where nobody works",
        asks=("Wipe {of}?",),
        arguments={"times": "How often."},
    ),
"""
LOOK = r"""
import contextlib, io, json, runpy, sys, types
from typer.testing import CliRunner
for name, member in (("rclpy.node", "Node"), ("std_srvs.srv", "Trigger")):  # without ROS 2, too
    made = type(member, (), {"Request": None, "Response": None})
    sys.modules[name.partition(".")[0]] = types.ModuleType(name)
    sys.modules[name] = types.SimpleNamespace(**{member: made})
from arboleda.cli.main import cli
from arboleda.dashboard.panel import OFFERS
from arboleda.dashboard.wording import words
from arboleda.model.messages import Verb
from arboleda_proofs.simulator.faults.operators import KINDS
from arboleda.testing.plants import shipped
from arboleda.rig.rig import Rig
from arboleda.views import view
from arboleda.web.api import make_app, verb_arguments, verb_of
from arboleda.web.access.auth import Role, allowed
from arboleda.web.schema.openapi import render
from arboleda_ros.verbs import VerbServices

rig, services, page = Rig(shipped()), [], io.StringIO()
verb = verb_of("wipe")
node = types.SimpleNamespace(create_service=lambda kind, name, serve: services.append(name))
VerbServices(node, None)
with contextlib.redirect_stdout(page):
    runpy.run_path("scripts/verb-reference", run_name="__main__")
refused = rig.operate(verb, "sis_a", times=3)
rig.submit("sis_a 0B 7")
rig.wait(5.0)
print(json.dumps({
    "refused": refused,
    "shown": "wipe" in view.snapshot(rig.plant)["cells"][1]["refused"],
    "other argument": rig.operate(verb, "sis_a", station=3),
    "done": rig.operate(verb, "sis_a", times=3),
    "said": str(rig.plant.acts[-1].sentence),
    "body": verb_arguments(b'{"times": 3}').of(verb),
    "schema": render(make_app(types.SimpleNamespace(ask=lambda _: None)).openapi()),
    "viewer": allowed(Role.VIEWER, "wipe"),
    "commands": CliRunner().invoke(cli, ["help", "operate"]).output,
    "help": CliRunner().invoke(cli, ["wipe", "--help"]).output,
    "offer": OFFERS["wipe"].scopes,
    "page": [[words(each)("verb.wipe"), words(each).asks("wipe")] for each in ("en", "es")],
    "ros": services,
    "people": [kind.name for kind in KINDS],
    "reference": page.getvalue(),
}))
"""


def test_a_verb_of_three_texts_is_done_offered_and_described_everywhere(tmp_path: Path) -> None:
    tree = CopiedTree(tmp_path)
    tree.insert("model/verbs.py", "\n    _value_: str", ROW)
    tree.insert("core/operator.py", "            Verb.ANSWER: Answering(", PROCEDURE)
    tree.insert("views/verb_words.py", "    Verb.ANSWER: VerbWords(", WORDS)
    assert len(tree.changed) == 3  # the two halves of its row, and its words
    seen = tree.run(LOOK)
    assert seen["refused"] == "sis_a is idle; only a cell at work can be held"
    assert seen["other argument"] == "wipe takes no argument 'station'"
    assert (seen["done"], seen["said"], seen["shown"]) == (None, "wipe sis_a 3", True)
    assert "wipe" in seen["commands"] and "Wipe a cell." in seen["commands"]
    assert "Has a cell wiped." in seen["help"] and "TIMES" in seen["help"] and "How often." in seen["help"]
    assert seen["body"] == [["times", 3]] and seen["viewer"] is False
    assert "<th>wipe</th>" in seen["schema"] and "How often." in seen["schema"]
    assert seen["offer"] == ["plant", "cell"]
    assert seen["page"] == [["Wipe it", ["Wipe {of}?"]]] * 2  # in English until Spanish has words for it
    assert "plant/wipe" in seen["ros"] and "operator_wipe" in seen["people"]
    assert "| `wipe` | has a cell wiped | where nobody works |" in seen["reference"]
