"""A proposal from its writing to its approval, and the task that is given after that, with `arboleda.client`.

It speaks for both sides, the program of an assistant and the person who approves. Make a plant for it first,
in another shell:

    arboleda new presses
    printf 'assistants: submit\\nassistant_limits: {cells: [cell]}\\n' >>presses/plant.yaml
    arboleda up --no-ros --plant presses/plant.yaml

Then `python examples/client/proposal_to_task.py`, or step by step: editors with notebooks run each part that
begins with `# %%` by itself. $PLANT is the address of the plant. Where the plant wants tokens, an assistant
has that of the role `assistant`, and Ana the operator's.
"""

# %% What there is to build on: targets, kinds and trees of the version at work.
import os
import time
from pathlib import Path
from tempfile import gettempdir

from arboleda.client import Plant, WrongRequest

plant = Plant(os.environ.get("PLANT", "http://127.0.0.1:8080"))
base = plant.proposal_base()
print("assistants:", plant.assistants().level, "- made for version", base.version[:12])
print("devices:", base.cells["cell"]["devices"])

# %% A tree, with a mistake: its problems come back as data, and nothing is kept.
TREE = """<root BTCPP_format="4" main_tree_to_execute="Airing">
  <BehaviorTree ID="Airing">
    <Sequence>
      {steps}
    </Sequence>
  </BehaviorTree>
</root>
"""
asked = {"name": "airing", "by": "a program", "recipes": ["airing"]}
wrong = plant.propose(**asked, words="First try.", trees={"airing.xml": TREE.format(steps="<press_shut/>")})
print("kept:", wrong.hash, "- problems:", wrong.problems)

# %% Without the mistake it is kept for people, under the hash of its content. Nothing of it is at work.
steps = "<press_close/>\n      <press_open/>\n      <loader_home/>"
kept = plant.propose(**asked, words="Moves the door once.", trees={"airing.xml": TREE.format(steps=steps)})
assert kept.hash is not None, kept.problems
print("kept:", kept.hash[:12], kept.stage, kept.changes)
try:
    plant.give("cell airing", "a program")
except WrongRequest as refused:
    print("refused:", refused.sentence)

# %% The plant tries it beside itself: without faults and with every single one, then on seeds with several.
plant.prove_proposal(kept.hash, recipes=["airing"], budget_s=3)
plant.simulate_proposal(kept.hash, seeds=2, cycles=2)
while True:
    found = plant.proposal(kept.hash)
    states = found.proof_state.state, found.simulation_state.state
    if "running" not in states:
        break
    time.sleep(0.5)
assert found.proof is not None and found.simulation is not None, states
print("proved:", found.proof["runs"], "findings:", found.proof["findings"], "mend:", found.proof["mend"])
print("simulated:", "held" if found.simulation["held"] else found.simulation["seeds"])

# %% What a person sees of it on the page too, under *Make*, *Proposals*: the difference, and a picture.
print(found.differences["airing.xml"])
picture = Path(gettempdir()) / "airing.svg"
picture.write_text(found.pictures["airing.xml"], "utf-8")
print("picture:", picture)

# %% Ana approves this very content, and it is put to work.
done = plant.approve(kept.hash, "Ana")
print(done.stage, "by", done.decided_by, "- version", done.version)

# %% Now the program may give tasks of it, within the limits of the plant file.
task = plant.give("cell airing #first", "a program")
print(plant.wait(task.id).state)
(row,) = plant.history(words=task.id)
print("asked by", row.asked_by, "-", row.choice)
plant.close()
