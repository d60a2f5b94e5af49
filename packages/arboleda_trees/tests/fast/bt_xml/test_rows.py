from __future__ import annotations

from arboleda_trees.bt_xml import rows

from .findings import looked_at, tree

INNER = '<BehaviorTree ID="In"><Fallback><A to="{x}"/><SubTree ID="In"/></Fallback></BehaviorTree>'


def test_a_subtree_is_drawn_in_its_place_and_once_where_it_contains_itself() -> None:
    forest, _, _ = looked_at(
        tree('<ReactiveSequence name="both"><SubTree ID="In"/><B/></ReactiveSequence>', INNER)
    )
    found = [(row["path"], str(row["name"]), row["kind"]) for row in rows.rows(forest, "Main")]
    assert found == [
        ("root", "both (ReactiveSequence)", "sequence"),
        ("0", "In", "step"),
        ("0.0", "Fallback", "selector"),
        ("0.0.0", "A to={x}", "step"),
        ("0.0.1", "In", "step"),
        ("1", "B", "step"),
    ]


def test_long_values_are_cut() -> None:
    forest, _, _ = looked_at(tree(f'<A to="{"x" * 100}"/>'))
    assert len(rows.rows(forest, "Main")[0]["name"]) == 62
