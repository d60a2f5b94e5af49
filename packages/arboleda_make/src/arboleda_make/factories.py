"""Factories for changing a plant that runs: drafts, versions, teaching, tries, and proposals."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.recording import Recording
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.parts.part import Part
from arboleda.runtime.rate import at_rate
from arboleda.runtime.registry import Assembly, Factory, Phase
from arboleda_make.drafts.api import DraftApi
from arboleda_make.proposals.api import ProposalsApi
from arboleda_make.teaching.api import TeachApi
from arboleda_make.trying.api import MakeApi
from arboleda_make.versions.api import VersionsApi
from arboleda_proofs.past.desk import OtherRecord, PastDesk


def desks(assembly: Assembly) -> Iterator[Part]:
    """The desks of the plant's files, which are known where a record is kept; and teaching."""
    local, recording = assembly.ask(LocalPlant), assembly.options.recording
    if local is None:
        return
    from .teaching.desk import TeachDesk

    made = [] if recording is None else _of_files(assembly, local, recording)
    teach = TeachDesk(local, assembly.ask(DraftApi))
    assembly.offer(TeachApi, teach)
    yield from made if "web" in assembly.parts else ()


def _of_files(assembly: Assembly, local: LocalPlant, recording: Recording) -> list[Part]:
    """The desks of its draft, of its versions, and of what is proposed."""
    from arboleda_make.drafts.process import CheckProcess

    from .drafts.desk import DraftDesk
    from .drafts.plant_folder import PlantFolder
    from .page.tried import TriedPlants
    from .proposals.desk import ProposalDesk
    from .trying.bench import MakeBench
    from .versions.desk import VersionDesk

    options, held = assembly.options, assembly.holdings
    state, process = held.state.path, CheckProcess()
    folder = PlantFolder(options.plant_file, state)

    def as_it_runs(model: PlantModel) -> PlantModel:
        return at_rate(model.on_boards(Link.DRIVER) if recording.virtual else model, options.rate)

    versions = VersionDesk(
        folder,
        state,
        assembly.need(Orchestrator),
        as_it_runs=as_it_runs,
        check=process.check,
        restarts=options.restarts and held.memory.lead.renew_s is None,
    )
    draft = DraftDesk(folder, state, process, work_by=versions.work_by, writing=versions.writing)
    make = MakeBench(folder, state, draft, assembly.model.driven)
    proposals = ProposalDesk(folder, state, versions, CheckProcess(), local)
    assembly.offer(VersionDesk, versions)
    assembly.offer(VersionsApi, versions)
    assembly.offer(DraftApi, draft)
    assembly.offer(MakeApi, make)
    assembly.offer(ProposalsApi, proposals)
    if past := assembly.ask(PastDesk):
        last_tried = TriedPlants(make.tried).last
        past.others["draft"] = OtherRecord(side=last_tried, may="looking at what was tried of a draft")
    assembly.notes.append(lambda: [folder.note] if folder.note else [])
    return [draft, make, proposals]


def hang_up(assembly: Assembly) -> Iterator[Part]:
    """The part that puts the plant's files to work at a SIGHUP."""
    if assembly.ask(VersionsApi) is not None:
        from .versions.desk import VersionDesk
        from .versions.hang_up import HangUpPart

        yield HangUpPart(assembly.need(VersionDesk).put_files)


FACTORIES = (
    Factory(phase=Phase.PAGE, make=desks),
    Factory(phase=Phase.AFTER, make=hang_up),
)
