"""The stages of a study; each takes data and returns data."""

from studies.stages.claim_rows import ROUNDING, Row, agrees, keeps, same, same_digest, shown_pose
from studies.stages.cycle_stage import Timing, time_cycle
from studies.stages.map_options import MapRequest, angles_of, map_request
from studies.stages.map_stage import MapOutcome, run_map, unit_of
from studies.stages.on_cycle import WorstOnCycle, require_on_cycle
from studies.stages.pipeline import GIVEN, Outcome, certified, designed, run, with_cycle
from studies.stages.proofs import Claim, Proof, Question, claims_of, prove_claims, question_of
from studies.stages.timed_stage import Lasting, Progress, stage
from studies.stages.unasked import became_worse, with_unasked

__all__ = [
    "GIVEN",
    "ROUNDING",
    "Claim",
    "Lasting",
    "MapOutcome",
    "MapRequest",
    "Outcome",
    "Progress",
    "Proof",
    "Question",
    "Row",
    "Timing",
    "WorstOnCycle",
    "agrees",
    "angles_of",
    "became_worse",
    "certified",
    "claims_of",
    "designed",
    "keeps",
    "map_request",
    "prove_claims",
    "question_of",
    "require_on_cycle",
    "run",
    "run_map",
    "same",
    "same_digest",
    "shown_pose",
    "stage",
    "time_cycle",
    "unit_of",
    "with_cycle",
    "with_unasked",
]
