from __future__ import annotations

import pytest

from arboleda_bench.cost.counter import count

from .findings import HEAD, looked_at, mistakes, tree, warnings

MODEL = (
    '<TreeNodesModel><Action ID="Go"><input_port name="to" type="int"/><output_port name="at"/></Action>'
    '<SubTree ID="Sub"><input_port name="n"/></SubTree></TreeNodesModel>'
)


@pytest.mark.parametrize(
    ("body", "place", "words"),
    [
        ("<Sequence/>", "3:1", "Sequence has no children; it needs 1 or more"),
        ("<Inverter><A/><B/></Inverter>", "3:1", "Inverter has 2 children; it needs 1"),
        ('<IfThenElse name="if"><A/></IfThenElse>', "3:1", "IfThenElse 'if' has 1 child; it needs 2 to 3"),
        ("<Sleep msec='1'><A/></Sleep>", "3:1", "Sleep has 1 child; it needs none"),
        ("<Sleep/>", "3:1", "Sleep needs msec: a whole number of milliseconds, or a variable"),
        ('<Sleep msec="soon"/>', "3:8", "msec of Sleep must be a whole number of milliseconds, is 'soon'"),
        ('<Sleep msec="-1"/>', "3:8", "must be a whole number of milliseconds"),
        ('<Sleep msec="1" sec="2"/>', "3:17", "Sleep has no port 'sec'; there are msec; did you mean msec?"),
        ('<Repeat num_cycles="1.5"><A/></Repeat>', "3:9", "must be a whole number, is '1.5'"),
        ('<Script code="x :="/>', "3:9", "'x :=': a value or a variable is expected, and the script ends"),
        ('<A _skipIf="1 +"/>', "3:4", "a value or a variable is expected"),
        ('<A _skipIf="{x}"/>', "3:4", "is nothing here"),
        ('<SubTree ID="Main2" _autoremap="yes"/>', "3:21", "_autoremap must be true or false, is 'yes'"),
        ("<Main/>", "3:1", 'Main is a tree; write <SubTree ID="Main"/>'),
        ('<SubTree name="x"/>', "3:1", "which?"),
        ("<Action/>", "3:1", "which?"),
        ('<SubTree ID="Sub"/>', "3:1", "the SubTree 'Sub' needs n"),
        ('<SubTree ID="Sub" n="1"><A/></SubTree>', "3:1", "has children"),
        ('<Go to="x" at="{a}"/>', "3:5", "to of Go must be a whole number, is 'x'"),
        ('<Parallel success="2"><A/></Parallel>', "3:11", "there are success_count, failure_count"),
        ('<Parallel success_count="all"><A/></Parallel>', "3:11", "must be a whole number"),
        ('<ParallelAll max_failures="3"><A/><B/></ParallelAll>', "3:14", "is 3, and it has 2 children"),
        (
            '<Parallel success_count="2"><A/></Parallel>',
            "3:11",
            "success_count of Parallel is 2, and it has 1",
        ),
        ('<Parallel failure_count="0x2"><A/></Parallel>', "3:11", "is 0x2, and it has 1 child"),
        ('<Parallel success_threshold="2"><A/></Parallel>', "3:11", "success_threshold of Parallel is 2"),
        ('<Precondition if="x" else="MAYBE"><A/></Precondition>', "3:22", "SUCCESS or FAILURE"),
        ('<A name="a&#x7f;"/>', "3:1", "control character 127"),
    ],
)
def test_a_mistake_is_told_with_its_place_and_what_to_do(body: str, place: str, words: str) -> None:
    (found,) = mistakes(tree(body, MODEL))
    assert found.startswith(f"t.xml:{place}: ") and words in found


def test_a_port_that_only_the_files_own_model_lacks_is_warned_of() -> None:
    (found,) = warnings(tree('<Go to="1" form="{a}"/>', MODEL))
    assert found.startswith(
        "t.xml:3:12: warning: its model in these files may be outdated: Go has no port 'form'"
    )


OLD = '<root><BehaviorTree ID="Main">{}</BehaviorTree><TreeNodesModel>{}</TreeNodesModel></root>'
OWN_SLEEP = '<Action ID="Sleep"><input_port name="seconds"/></Action>'


@pytest.mark.parametrize(
    ("body", "model"),
    [
        ('<Sleep seconds="2"/>', OWN_SLEEP),
        ("<Sleep/>", '<Action ID="Sleep"/>'),
        ("<Action ID='TryCatch'/>", '<Action ID="TryCatch"/>'),
        ('<RoundRobin of="1"/>', '<Action ID="RoundRobin"><input_port name="of"/></Action>'),
    ],
)
def test_a_file_of_version_3_may_have_nodes_called_as_later_ones(body: str, model: str) -> None:
    _, findings, leaves = looked_at(OLD.format(body, model))
    assert findings.mistakes == () and findings.warnings == () and leaves == []


def test_a_model_that_agrees_with_a_built_in_kind_means_that_one() -> None:
    model = '<Action ID="Sleep"><input_port name="msec"/></Action>'
    assert "msec of Sleep must be" in mistakes(OLD.format('<Sleep msec="soon"/>', model))[0]


def test_in_a_file_of_version_4_its_own_kinds_have_their_names_alone() -> None:
    assert (
        "Sleep has no port 'seconds'"
        in mistakes(tree('<Sleep msec="1" seconds="2"/>', f"<TreeNodesModel>{OWN_SLEEP}</TreeNodesModel>"))[0]
    )


def test_a_tree_called_as_a_later_kind_of_node_is_warned_of_in_a_file_of_version_3() -> None:
    trees = [f'<BehaviorTree ID="{name}"><A/></BehaviorTree>' for name in ("Sleep", "RoundRobin")]
    text = f"<root>{''.join(trees)}</root>"
    assert mistakes(text) == ()
    (found,) = warnings(text)
    assert "BehaviorTree.CPP 4 has a kind of node Sleep, too" in found and found.endswith(
        "1 more like it: line 1"
    )


def test_warnings_of_one_kind_in_a_file_are_one_line_with_a_count() -> None:
    leaves = "\n".join(f'<Action ID="a b{n}"/>' for n in range(14))
    (found,) = warnings(tree(f"<Sequence>{leaves}</Sequence>"))
    assert found.startswith("t.xml:3:11: warning: newer editors refuse 'a b0' as the name of a node")
    assert found.endswith("; 13 more like it: line 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, ...")


def test_all_mistakes_are_told_at_once_in_the_order_of_the_file() -> None:
    found = mistakes(tree('<Sequence>\n<Inverter/>\n<Sleep msec="x"/>\n<Sleep/>\n</Sequence>'))
    assert [line.split(": ")[0] for line in found] == ["t.xml:4:1", "t.xml:5:8", "t.xml:6:1"]


def test_of_very_many_mistakes_the_rest_is_counted() -> None:
    found = mistakes(tree("<Sequence>" + "<Inverter/>" * 205 + "</Sequence>"))
    assert len(found) == 201 and found[-1] == "and 5 mistakes more"


def test_a_node_with_more_children_than_any_can_have_is_told_how_many_it_can_have() -> None:
    (found,) = mistakes(tree("<Sequence>" + "<A/>" * 1001 + "</Sequence>"))
    assert found.endswith("Sequence has 1001 children; it needs at most 1000")


def test_a_node_with_children_that_nobody_knows_is_warned_of_once() -> None:
    found = warnings(tree("<Sequence><Mine><A/></Mine>\n<Mine><Mine><B/></Mine></Mine></Sequence>"))
    assert [each.split(": ")[0] for each in found] == ["t.xml:3:11"]


def test_leaves_that_nobody_knows_are_listed_and_not_refused() -> None:
    _, findings, leaves = looked_at(tree('<Sequence><Zap x="{y}"/><Action ID="Beep"/><Zap/></Sequence>'))
    assert findings.mistakes == () and findings.warnings == () and leaves == ["Beep", "Zap"]


@pytest.mark.parametrize(
    ("body", "place", "words"),
    [
        ("<Sequence><AlwaysFailure/><A/></Sequence>", "3:27", "A can never be reached"),
        ("<Fallback><ForceSuccess><A/></ForceSuccess><B name='b'/></Fallback>", "3:44", "B 'b' can never"),
        ("<Sequence><Repeat num_cycles='-1'><A/></Repeat><B/></Sequence>", "3:48", "B can never"),
        ("<IfThenElse><AlwaysSuccess/><A/><B/></IfThenElse>", "3:33", "B can never"),
        ("<Fallback><Sequence><Script code='x:=1'/></Sequence><B/></Fallback>", "3:53", "B can never"),
        ("<ScriptCondition code='a &amp;&amp; b && c == 1'/>", "3:39", "a raw & is no XML"),
        ('<ScriptCondition code="door == 1"/>', "3:18", "the variable 'door' is read, and nothing"),
        ('<Sleep msec="{pause}"/>', "3:8", "the variable 'pause' is read"),
        ("<Sequnce><A/></Sequnce>", "3:1", "nobody here knows Sequnce, which has children; did you mean S"),
        ("<Mine><A/></Mine>", "3:1", '<Decorator ID="Mine"/> in the TreeNodesModel'),
        ("<Mine><A/><B/></Mine>", "3:1", "Mine, which has children; to have it run, declare <Control ID="),
        ("<ForEachUntilSuccess vector_in='1' out='{x}'><A/></ForEachUntilSuccess>", "3:1", "nobody here kn"),
        ("<Sequnce/>", "3:1", "nobody here knows Sequnce; did you mean Sequence?"),
        ('<SubTree ID="Elsewhere"/>', "3:10", "is in none of these files"),
        ('<Action ID="Open the door"/>', "3:1", "newer editors refuse 'Open the door'"),
        ('<A a.b="1"/>', "3:4", "newer editors refuse 'a.b' as the name of a port"),
        ('<Go to="1" at="here"/>', "3:12", 'version 4 wants at="{...}"'),
        ('<Go at="{x}"/>', "3:1", "Go needs to"),
    ],
)
def test_what_may_be_wrong_is_a_warning(body: str, place: str, words: str) -> None:
    text = tree(body, MODEL)
    assert mistakes(text) == ()
    assert any(each.startswith(f"t.xml:{place}: warning: ") and words in each for each in warnings(text))


@pytest.mark.parametrize(
    "body",
    [
        "<Sequence><AlwaysFailure _skipIf='true'/><A/></Sequence>",
        "<Fallback><Script code='x:=1' _failureIf='true'/><B/></Fallback>",
        "<Fallback><Timeout msec='9'><Sleep msec='99'/></Timeout><B/></Fallback>",
        "<Sequence><ForceFailure><A/></ForceFailure></Sequence>",
        "<Sequence><SubTree ID='Main2'/><A/></Sequence>",
        "<Fallback><AlwaysFailure/><A/></Fallback>",
        "<IfThenElse><A/><AlwaysFailure/><B/></IfThenElse>",
        "<Sequence><SetBlackboard value='1' output_key='x'/><Sleep msec='{x}'/></Sequence>",
        "<Sequence><Script code='x:=1'/><Sleep msec='{x}'/></Sequence>",
        "<ParallelAll max_failures='2'><A/><B/></ParallelAll>",
        "<ParallelAll max_failures='-5'><A/><B/></ParallelAll>",
        "<Parallel failure_count='2'><A/><B/></Parallel>",
        "<Sequence><Zap any='{x}'/><Sleep msec='{x}'/></Sequence>",
        "<ForEach vector_in='1;2' out='{x}'><Sleep msec='{x}'/></ForEach>",
    ],
)
def test_what_can_be_is_not_warned_of(body: str) -> None:
    assert warnings(tree(body, '<BehaviorTree ID="Main2"><A/></BehaviorTree>')) == ()


def test_a_variable_may_come_from_the_tree_around_or_from_one_within() -> None:
    steps = '<Sleep msec="{pause}"/><Script code="out := 1"/>'
    inner = f'<BehaviorTree ID="In"><Sequence>{steps}</Sequence></BehaviorTree>'
    body = '<Sequence><SubTree ID="In" pause="5" out="{found}"/><Sleep msec="{found}"/></Sequence>'
    assert warnings(tree(body, inner)) == ()
    (found,) = warnings(tree('<SubTree ID="In" out="{found}"/>', inner))
    assert "'pause' is read" in found


def test_names_that_are_shared_are_not_missed_and_those_of_the_outermost_tree_are_found() -> None:
    inner = (
        '<BehaviorTree ID="In"><Sequence><Sleep msec="{a}"/><Sleep msec="{@b}"/></Sequence></BehaviorTree>'
    )
    body = '<Sequence><Script code="b:=1"/><SubTree ID="In" _autoremap="true"/></Sequence>'
    assert warnings(tree(body, inner)) == ()
    text = tree('<SubTree ID="In" a="1"/>', inner)
    (found,) = warnings(text.replace("<root", '<root main_tree_to_execute="Main"'))
    assert "'@b' is read" in found


REPEATS, SLEEPS = '<Repeat num_cycles="{n}"><A/></Repeat>', '<Sleep msec="{n}"/>'
ASKS = '<Switch2 variable="{n}" case_1="1" case_2="2"><A/><A/><A/></Switch2>'
WITHIN = '<SubTree ID="In" {}/>'
CLASHES = [
    (
        REPEATS + SLEEPS,
        "3:56: {n} is given to num_cycles of Repeat (int) at t.xml:3:19 and to msec of Sleep (",
    ),
    (
        SLEEPS + REPEATS,
        "3:38: {n} is given to msec of Sleep (unsigned) at t.xml:3:18 and to num_cycles of Re",
    ),
    (REPEATS + ASKS, "(string); BehaviorTree.CPP refuses a variable of two types; take one for each"),
    (REPEATS + SLEEPS.replace("{n}", "{@n}"), None),
    (REPEATS + WITHIN.format('k="{n}"'), "5:40: {n} is given to"),
    (
        WITHIN.format('k="{n}"') + REPEATS,
        "{n} is given to msec of Sleep (unsigned) at t.xml:5:40 and to num_c",
    ),
    (REPEATS.replace("{n}", "{k}") + WITHIN.format('_autoremap="true"'), "5:40: {k} is given"),
    (REPEATS + WITHIN.format(""), "5:40: {n} is given"),
    (ASKS + REPEATS, None),
    ('<SetBlackboard value="1" output_key="{n}"/>' + REPEATS + SLEEPS, None),
    (REPEATS + WITHIN.format('k="5"'), None),
    (REPEATS + WITHIN.format('k="{m}"'), None),
    (REPEATS + WITHIN.format('k="5" _autoremap="true"'), None),
    (REPEATS + REPEATS, None),
]


@pytest.mark.parametrize(("body", "words"), CLASHES)
def test_a_variable_of_two_types_is_refused_where_the_original_does(body: str, words: str | None) -> None:
    """The expected words are those of version 4.10 on these trees."""
    inner = '<BehaviorTree ID="In"><Sequence><Sleep msec="{k}"/></Sequence></BehaviorTree>'
    model = '<TreeNodesModel><SubTree ID="In"><input_port name="k" default="{n}"/></SubTree></TreeNodesModel>'
    found = mistakes(tree(f"<Sequence>{body}</Sequence>", inner + model))
    assert len(found) == (words is not None) and (words or "") in "".join(found)


def test_a_variable_of_two_types_is_a_warning_where_a_model_says_one_of_them() -> None:
    body = '<Sequence><Go to="{n}" at="{m}"/><Sleep msec="{n}"/></Sequence>'
    assert mistakes(tree(body, MODEL)) == ()
    assert any("to of Go (int)" in each for each in warnings(tree(body, MODEL)))


def test_a_tree_that_contains_itself_is_told_once_with_the_way() -> None:
    more = '\n<BehaviorTree ID="B">\n<Sequence><SubTree ID="Main"/></Sequence></BehaviorTree>'
    (found,) = mistakes(tree('<SubTree ID="B"/>', more))
    assert "contains itself" in found and found.count(">") == 2
    (alone,) = mistakes(tree('<SubTree ID="Main"/>'))
    assert alone == "t.xml:3:1: the tree Main contains itself: Main > Main"


def test_each_node_is_read_and_checked_with_few_calls() -> None:
    """Counted, as no clock tells a slow program from a busy machine."""
    ten = (
        '<Fallback name="f"><Sequence><Go to="{x}" at="{y}" _skipIf="a &lt; 3 &amp;&amp; b == \'no\'"/>'
        '<Script code="x := 3; y = x + 2"/><Sleep msec="10"/></Sequence>'
        '<Timeout msec="100"><RetryUntilSuccessful num_attempts="3"><Inverter><Zap/></Inverter>'
        "</RetryUntilSuccessful></Timeout></Fallback>"
    )
    calls = {}
    for times in (28, 56):
        text = tree(f"<Sequence>{ten * times}</Sequence>", MODEL)
        forest, findings, _ = looked_at(text)
        assert findings.mistakes == () and len(list(forest.trees["Main"].root.iterate())) == 9 * times + 1
        calls[times] = sum(count(lambda text=text: looked_at(text)).values())
    assert calls[56] < 505 * 250, "some hundredths of a second"
    assert calls[56] < 2.1 * calls[28], "twice the nodes take twice the calls"


def test_what_is_no_file_of_trees_is_told() -> None:
    assert mistakes("<robot/>") == ("t.xml:1:1: the outermost tag is <robot>; it must be <root>",)
    assert mistakes('<root BTCPP_format="5"><BehaviorTree><A/></BehaviorTree></root>') == (
        "t.xml:1:7: BTCPP_format is '5'; 3 and 4 are known",
    )
    assert warnings(f"{HEAD}<Trees/></root>") == (
        "t.xml:1:24: warning: <Trees> means nothing here; BehaviorTree, TreeNodesModel, include do",
    )
