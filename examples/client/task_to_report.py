"""A task from its submission to its report, over HTTP with `arboleda.client`.

Start a plant first, in another shell: `arboleda up --no-ros`. Then
`python examples/client/task_to_report.py`, or step by step: editors with notebooks run each part that begins
with `# %%` by itself. $PLANT is the address of the plant.
"""

# %% A plant. `token=` is needed where it is open to a network.
import os

from arboleda.client import Plant, WrongRequest

plant = Plant(os.environ.get("PLANT", "http://127.0.0.1:8080"))
for offer in plant.recipes():
    print(offer.cell, [recipe.form for recipe in offer.recipes])

# %% A task, by names and values; what cannot be is refused with a sentence.
try:
    plant.submit_form(cell="sis_a", values={"path": "0B", "station": 99})
except WrongRequest as refused:
    print("refused:", refused.sentence, refused.key)
task = plant.submit_form(cell="sis_a", values={"path": "0B", "station": 7})

# %% Its course, until it has ended.
for now in plant.follow(task.id):
    print(now.id, now.state, now.sentence)

# %% Another one, which fails: the cell is stopped (software) while it works.
task = plant.submit("sis_a 0B 7")
for now in plant.follow(task.id):
    print(now.id, now.state, now.sentence)
    if now.state == "running":
        print("stop:", plant.stop("sis_a").outcome)

# %% Why: the report, which the plant makes of its record.
report = plant.report(task.id)
assert report.cause and report.evidence
print(f"cause: {report.cause.kind}: {report.cause.sentence}")
for act in report.evidence.acts:
    print(f"{act.at_s:+.2f} s {act.words}")

# %% The way out, as the plant advises it.
(cell,) = (each for each in plant.snapshot().cells if each.name == "sis_a")
for advice in cell.advice:
    print("advice:", advice.said, "-", advice.why)

# %% What has been done, as rows; `plant.history().to_pandas()` where pandas is installed.
for row in plant.history(cell="sis_a", limit=2):
    print(row.number, row.id, row.state, row.reason)
plant.close()
