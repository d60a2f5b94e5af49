"""The form for tasks, as HTML."""

from __future__ import annotations

from arboleda.dashboard import task_form
from arboleda.dashboard.tags import markup
from arboleda.dashboard.wording import words
from arboleda.testing import shipped
from arboleda.views import view


def test_an_end_of_a_path_has_its_letter() -> None:
    html = markup(lambda: task_form.build(view.layout(shipped()), words("en")))
    for label in ("6 A", "7 B", "8 C"):
        assert f'title="node {label[0]}: an end">{label}</button>' in html
    assert 'title="node 0: a start">0</button>' in html
