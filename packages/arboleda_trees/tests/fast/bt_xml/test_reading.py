from __future__ import annotations

from arboleda.recipes.of_files import Mark
from arboleda_trees.bt_xml import nodes

from .findings import HEAD, looked_at, mistakes, tree, warnings

COMPACT = '<Sequence name="both"><Gripper open="{o}" _skipIf="o"/><SubTree ID="Go" to="7"/></Sequence>'
EXPLICIT = (
    '<Control ID="Sequence" name="both"><Action ID="Gripper" open="{o}" _skipIf="o"/>'
    '<SubTree ID="Go" to="7"/></Control>'
)


def shape(text: str) -> list[tuple[str, str, dict[str, str]]]:
    forest, _, _ = looked_at(tree(text))
    nodes = forest.trees["Main"].root.iterate()
    return [(node.kind, node.name, {name: each.value for name, each in node.ports.items()}) for node in nodes]


def test_both_forms_are_the_same_tree() -> None:
    assert shape(COMPACT) == shape(EXPLICIT)
    assert shape(COMPACT)[0] == ("Sequence", "both", {})


def test_attributes_of_editors_are_kept_and_are_no_ports() -> None:
    text = tree(
        '<SubTree ID="Main2" _collapsed="true" x="1"/>',
        '<BehaviorTree ID="Main2" _fullpath="a"><A/></BehaviorTree>',
    )
    forest, _, _ = looked_at(text)
    root = forest.trees["Main"].root
    assert root.own["_collapsed"].value == "true" and set(root.ports) == {"x"}
    assert forest.trees["Main2"].own["_fullpath"].value == "a"


def test_spellings_of_version_3_are_read_as_those_of_4() -> None:
    body = (
        '<SequenceStar><RetryUntilSuccesful num_attempts="2"><A/></RetryUntilSuccesful>'
        '<SubTreePlus ID="Other" __autoremap="true"/></SequenceStar>'
    )
    text = f'<root main_tree_to_execute="Main"><BehaviorTree ID="Main">{body}</BehaviorTree>'
    forest, findings, _ = looked_at(text + '<BehaviorTree ID="Other"><A/></BehaviorTree></root>')
    found = [node.kind for node in forest.trees["Main"].root.iterate()]
    assert findings.mistakes == () and forest.main == "Main"
    assert found == ["SequenceWithMemory", "RetryUntilSuccessful", "A", "SubTree"]


def test_included_files_are_read_once_and_in_a_ring_too() -> None:
    text = tree('<SubTree ID="Go"/>', '<include path="go.xml"/>')
    go = f'{HEAD}<include path="go.xml"/><BehaviorTree ID="Go"><A/></BehaviorTree></root>'
    forest, findings, leaves = looked_at(text, go=go)
    assert set(forest.trees) == {"Main", "Go"} and leaves == ["A"] and findings.mistakes == ()


def test_a_file_that_cannot_be_included_is_named_where_it_is_named() -> None:
    assert mistakes(tree("<A/>", '<include path="no.xml"/>\n')) == (
        "t.xml:5:10: no.xml: there is no such file",
    )
    assert mistakes(tree("<A/>", "<include/>\n")) == ('t.xml:5:1: which file? <include path="..."/>',)


def test_a_mistake_in_an_included_file_is_told_with_its_name() -> None:
    (found,) = mistakes(tree("<A/>", '<include path="go.xml"/>'), go=f"{HEAD}<BehaviorTree ID='G'></root>")
    assert found.startswith("go.xml:1:47: this is not XML: mismatched tag")


def test_the_trees_of_a_file_that_is_not_here_are_not_missed() -> None:
    text = tree('<SubTree ID="Far"/>', '<include ros_pkg="pick" path="far.xml"/>')
    assert mistakes(text) == ()
    assert warnings(text) == ("t.xml:5:25: warning: there is no package pick",)


def test_the_main_tree_is_the_named_one_or_the_only_one() -> None:
    two = '<BehaviorTree ID="A"><X/></BehaviorTree><BehaviorTree ID="B"><X/></BehaviorTree></root>'
    assert looked_at(HEAD + two)[0].main is None
    assert looked_at(f'<root BTCPP_format="4" main_tree_to_execute="B">{two}')[0].main == "B"
    assert looked_at(tree("<X/>"))[0].main == "Main"
    assert mistakes(f'<root BTCPP_format="4"\nmain_tree_to_execute="C">{two}') == (
        "t.xml:2:1: there is no tree 'C'; there are A, B",
    )


def test_models_declare_kinds_with_their_ports() -> None:
    more = (
        '<TreeNodesModel><Decorator ID="Around"><input_port name="n" type="int" default="3"/></Decorator>'
        '<Action ID="Look"><output_port name="seen" type="std::string">what</output_port></Action>'
        "</TreeNodesModel>"
    )
    forest, findings, leaves = looked_at(tree('<Around><Look seen="{s}"/></Around>', more))
    assert findings.mistakes == () and leaves == []
    assert forest.models["Around"].category is nodes.Category.DECORATOR
    port = (forest.models["Around"].ports or {})["n"]
    assert (port.type, port.default, port.is_needed) == ("int", "3", False)
    assert (forest.models["Look"].ports or {})["seen"].direction is nodes.PortDirection.OUT


def test_trees_need_names_and_one_node_and_to_be_there_once() -> None:
    one = "<BehaviorTree ID='U'><A/></BehaviorTree>\n"
    text = f"{HEAD}\n<BehaviorTree><A/></BehaviorTree>\n<BehaviorTree ID='T'/>\n{one}"
    assert mistakes(f"{text}{one}</root>") == (
        't.xml:2:1: each of several trees needs a name: <BehaviorTree ID="...">',
        "t.xml:3:1: the tree T has 0 nodes below it, not 1",
        "t.xml:5:1: there are two trees U; the other is at t.xml:4:1",
    )


def test_a_place_is_of_the_tag() -> None:
    forest, _, _ = looked_at(tree("  <A/>"))
    assert forest.trees["Main"].root.place.mark == Mark(3, 3)
