"""The plant's memory in a real SQLite file, of a process that is killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from arboleda.model.messages import Fact
from arboleda.store.sqlite import Store

AT_FULL = """
import os, signal, sys
from pathlib import Path
from arboleda.store.sqlite import Store
from arboleda.model.messages import Fact, Journal, Remember, Verb
from arboleda.model.sentence import OWN
store = Store(Path(sys.argv[1]))
store.open()
for fact in Fact:
    store.keep(Remember(fact=fact, name="ra1", value="on"))
store.acts.keep(Journal(verb=Verb.STOP, scope="", cell=None, sentence=OWN(text="everything stopped")), 5.0)
print("kept", flush=True)
signal.pause()
"""


def test_what_was_kept_survives_kill_9(tmp_path: Path) -> None:
    path = tmp_path / "plant.sqlite"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", AT_FULL, str(path)]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as child:
        try:
            assert child.stdout is not None and child.stdout.readline() == "kept\n"
        finally:
            child.send_signal(signal.SIGKILL)
    assert child.returncode == -signal.SIGKILL
    with Store(path) as store:
        assert [store.facts(fact) for fact in Fact] == [{"ra1": "on"}] * len(Fact)
        assert [entry.sentence for entry in store.acts.last()] == ["everything stopped"]
