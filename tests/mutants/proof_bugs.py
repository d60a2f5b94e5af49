"""Every bug for `prove`, and those of which neither `check` nor a calm run is known to say anything.

Single faults may find some of these: `python -m tests.mutants.planted_proof` tries that; who is found
leaves the list. Most are of examples without places, where nothing counts parts.
"""

from __future__ import annotations

from .proof_bugs_of_arms import BUGS_OF_ARMS
from .proof_bugs_of_benches import BUGS_OF_BENCHES
from .proof_bugs_of_labs import BUGS_OF_LABS

PROOF_BUGS = (*BUGS_OF_BENCHES, *BUGS_OF_ARMS, *BUGS_OF_LABS)
NO_PLACES = "no place counts the part"
FAULTS_ALONE = "only a fault could show it"
WITHOUT_TIME = "its calm run was not looked at"
NOT_FOUND = {
    ("lab_bench", "What the pump says does not matter."): FAULTS_ALONE,
    ("kitting", "The cart rolls in before it is there."): "the lift needs nothing of the cart",
    ("kitting", "The picker does not grip."): "a tray that people fill may lose no part",
    ("kitting", "The lift is not held while the shuttle is there."): "what another cell does is not tried",
    ("kitting", "The zone to the lift is forgotten."): "the platform is no place of the lift",
    ("assembly", "It is clamped before it is there."): NO_PLACES,
    ("assembly", "The clamp opens when the arm has left with the part."): NO_PLACES,
    ("assembly", "It presses twice."): "it does no harm",
    ("assembly", "The lid is not gripped."): NO_PLACES,
    ("assembly", "The base is not let go of."): NO_PLACES,
    ("assembly", "The finished part is not gripped."): NO_PLACES,
    ("assembly", "The right arm stays where it was."): "nobody says that it ends at home",
    ("assembly", "The left arm stays where it was."): "nobody says that it ends at home",
    ("assembly", "The ram keeps nobody out."): FAULTS_ALONE,
    ("machine_tending", "The jaw opens before the clamp holds."): NO_PLACES,
    ("machine_tending", "The clamp opens before anybody grips."): NO_PLACES,
    ("machine_tending", "The jaw does not close."): NO_PLACES,
    ("machine_tending", "The tender keeps a bad part."): WITHOUT_TIME,
    ("machine_tending", "The good part is not put down."): WITHOUT_TIME,
    ("machine_tending", "Nobody looks whether the belt is clear."): FAULTS_ALONE,
    ("machine_tending", "The belt is never told to clear."): WITHOUT_TIME,
    ("machine_tending", "The door keeps nobody out."): FAULTS_ALONE,
    ("machine_tending", "The jaw is nobody's tool."): WITHOUT_TIME,
    ("lab", "The clamp holds no part."): "the recipe opens the clamp in time",
    ("rail", "What the oven says does not matter."): FAULTS_ALONE,
    ("rail", "What the driver says does not matter."): FAULTS_ALONE,
    ("rail", "The zone at the north is forgotten."): FAULTS_ALONE,
    ("rail", "The carriage may leave while the jaw holds."): FAULTS_ALONE,
}
