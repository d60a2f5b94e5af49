"""A language is added by a folder: page, login, waiting room and report speak it then."""

from __future__ import annotations

from pathlib import Path

from .copied_tree import CopiedTree

FILES = {
    "page": "name: Français\ntab:\n  cells: Cellules\nverb:\n  stop: Arrêt (logiciel)\n"
    "sentences:\n  refusal.only_aborted: '{cell} : {state}, rien à acquitter'\n",
    "login": "title: Entrer\ntoken: Clé\n",
    "waiting": "stands_by: Ce processus attend.\nlost: Aucune réponse.\n",
    "report": "title: La tâche {task} a échoué\ncause: Cause trouvée\n",
}
LOOK = r"""
import asyncio, httpx, json, types
from fastapi import FastAPI
from arboleda.core.verbs.stops import ONLY_ABORTED
from arboleda.dashboard import settings
from arboleda.dashboard.shell import language_of
from arboleda.dashboard.tags import markup
from arboleda.dashboard.wording import words
from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import OWN
from arboleda_proofs.playback.report.page import Report, page
from arboleda_proofs.playback.report.tries import ForkTrial
from arboleda_proofs.playback.cause import Cause
from arboleda_proofs.playback.incident import Incident
from arboleda_fleet.standby.waiting_room import waiting_page
from arboleda.testing.plants import shipped
from arboleda.web.access import login

app = FastAPI()
app.include_router(login.routes())

async def nobody(scope, receive, send):  # logged in
    await app({**scope, "arboleda.login": None}, receive, send)

async def go(app, method, path, headers):
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app=app), base_url="http://plant") as client:
        return await client.request(method, path, headers=headers)

def ask(app, method, path, **headers):
    return asyncio.run(go(app, method, path, headers))

fork = ForkTrial(what="without", value=0.0, end="", done=True, alike=True, options="")
failure = Failure(reason=Reason.REJECTED, sentence=OWN(text="no"))
incident = Incident(task="t-1", failure=failure, failed_at=1.0)
report = Report(incident=incident, cause=Cause(kind="", robot=None, sentence=OWN(text="why")),
                model=shipped(), tries=[fork], case="", command="")
browser = types.SimpleNamespace(headers={"accept-language": "fr-CA, en"}, query_params={}, cookies={})
print(json.dumps({
    "chosen": language_of(browser),
    "page": [words("fr")(key) for key in ("tab.cells", "verb.stop", "tasks.send")],
    "said": words("fr").say(ONLY_ABORTED(cell="a", state="idle")),
    "settings": markup(lambda: settings.build(words("fr"), None)),
    "login": ask(nobody, "GET", "/login", **{"accept-language": "fr-CA"}).text,
    "waiting": waiting_page("shop", "waits", None),
    "report": page(report),
}))
"""


def test_page_login_waiting_room_and_report_speak_a_language_of_a_folder(tmp_path: Path) -> None:
    tree = CopiedTree(tmp_path)
    for name, text in FILES.items():
        tree.add(f"web/languages/fr/{name}.yaml", text)
    assert {Path(each).parent for each in tree.changed} == {Path("web/languages/fr")}
    seen = tree.run(LOOK)
    assert seen["chosen"] == "fr"
    assert seen["page"] == ["Cellules", "Arrêt (logiciel)", "Send task"]  # the last has no French words
    assert seen["said"] == "a : idle, rien à acquitter"
    assert 'data-language="fr"' in seen["settings"] and "Français" in seen["settings"]
    assert '<html lang="fr">' in seen["login"] and "Clé" in seen["login"] and "Log in" in seen["login"]
    assert '<p lang="fr">Ce processus attend.</p>' in seen["waiting"]
    assert '<span lang="fr">Aucune réponse.</span>' in seen["waiting"]
    assert "<span lang=fr>La tâche t-1 a échoué</span>" in seen["report"]
    assert "English / Español / Français" in seen["report"] and '["en", "es", "fr"]' in seen["report"]
    assert "html[lang=fr] body [lang]:not([lang=fr])" in seen["report"]
