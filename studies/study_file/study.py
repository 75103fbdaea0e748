"""The study: the content of `study.toml` as a frozen model in SI and radians."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, SkipValidation, model_validator

from design import DENSE, MOST_BOXES, STARTS
from kinematics import Mechanism
from studies.study_file.keys import Key, Table
from studies.study_file.machine_tables import (
    InertiaTable,
    LoadTable,
    MaterialTable,
    Ranges,
    StructureTable,
    SurroundingsTable,
)
from studies.study_file.questions import digest_of, plain
from studies.study_file.table import Entry, Interval, Name, Positive, StudyTable, gathered, table_of
from studies.study_file.trajectory_tables import TrajectoryTable
from studies.study_file.units import Dimension

LENGTH = Dimension.LENGTH
Coordinate = float | Interval
GeometryValue = float | tuple[float, ...] | tuple[tuple[float, ...], ...]

REGION_KINDS = ("box", "cylinder")
KIND = Key("one of", choices=REGION_KINDS)


class _RegionTable(StudyTable):
    coordinates: dict[str, Coordinate]
    """The bounds of each pose coordinate: (low, high), or a number that fixes it [m or rad]."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return gathered(cls, data)


class BoxTable(_RegionTable):
    """Every pose coordinate has an interval or a fixed value."""

    kind: Annotated[Literal["box"], KIND]
    """The shape. Give every coordinate of the pose too."""


class CylinderTable(_RegionTable):
    """x and y are within `radius` [m] of the z axis; `coordinates` has the other coordinates."""

    kind: Annotated[Literal["cylinder"], KIND]
    """The shape. Give every coordinate of the pose too, except x and y."""
    radius: Annotated[Positive, Key("a length > 0", LENGTH)]
    """The largest distance from the z axis."""


class HomeTable(StudyTable):
    """The pose that the robot works around: its working mode follows from it, and an approach starts there."""

    coordinates: dict[str, float]
    """The pose [m or rad]. A coordinate that is not given is in the middle of the region."""
    joints: Annotated[tuple[float, ...] | None, Key("a finite number a joint")] = None
    """Joints near those at home. They choose the branch of each limb, such as elbow in. None takes the usual ones."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return gathered(cls, data)


class FviTable(StudyTable):
    """The numbers of the force-velocity index (39): what each joint gives, and what is wanted."""

    joint_speed: Annotated[Positive, Key("a speed > 0", Dimension.JOINT_SPEED)]
    """The largest speed of each joint."""
    joint_effort: Annotated[Positive, Key("an effort > 0 (N m, or N on a rail)")]
    """The largest torque or force of each joint."""
    speed: Annotated[Positive, Key("a speed > 0 (m/s)")]
    """The wanted worst isotropic speed [m/s]."""
    force: Annotated[Positive, Key("a force > 0 (N)")]
    """The wanted worst isotropic force [N]."""
    characteristic_length: Annotated[Positive | None, Key("a length > 0", LENGTH)] = None
    """The length that makes a rotation a length. None takes the mechanism's own."""


class SumTable(StudyTable):
    """A limit: the sum of the geometry's `fields` is at most `at_most` [m]."""

    fields: Annotated[Annotated[tuple[Name, ...], Field(min_length=1)], Key("a list out of")]
    """The lengths of the geometry that are added. Lists are added entry by entry."""
    at_most: Annotated[Positive, Key("a length > 0", LENGTH)]
    """The largest sum that is allowed."""


class OptimiseTable(StudyTable):
    """What the optimisation may change."""

    seed: Annotated[int, Field(ge=0, lt=2**32), Key("a whole number from 0 to 2^32 - 1")] = 0
    """The seed of the random starts."""
    starts: Annotated[int, Field(ge=1, le=10_000), Key("a whole number from 1 to 10000")] = STARTS
    """How many geometries to start from. The study's own is the first."""
    variables: Annotated[dict[str, Interval | tuple[Entry, ...]], Field(min_length=1), Table({})]
    """The bounds of each variable: (low, high), or a pair for each entry of a list. Equal bounds fix an entry."""
    sums: Annotated[tuple[SumTable, ...], table_of(SumTable, rows=True)] = ()
    """Limits of sums of lengths."""


class RequirementTable(StudyTable):
    """A margin and the bound that it must reach."""

    margin: Annotated[str, Key("one of")]
    """The margin."""
    at_least: Annotated[float | None, Key("a finite number")] = None
    """The lowest value that is allowed, at every pose of the region and on the cycle. For reach it is 0 or more."""
    at_most: Annotated[float | None, Key("a finite number")] = None
    """The highest value that is allowed, in place of `at_least`, of a margin that is better smaller."""


class CertifyTable(StudyTable):
    """The proofs over the region: each required margin at its bound, the objective and any other margin at its best."""

    margins: Annotated[tuple[Name, ...] | None, Key("a list out of")] = None
    """The margins to prove. None takes all required margins, and the objective."""
    tolerance: Annotated[Positive, Field(lt=1), Key("a number above 0 and below 1")] = 1e-4
    """How far a best bound may stay below the lowest value found, relative to that value."""
    most_boxes: Annotated[int, Field(ge=4, le=8_000_000), Key("a whole number from 4 to 8000000")] = MOST_BOXES
    """The largest number of boxes for a claim. A claim that needs more is undecided."""


Seconds = Annotated[Positive, Key("a time > 0 (s)")]


class BudgetTable(StudyTable):
    """The time that each stage may take. A result that it reaches in this time is kept and reported."""

    optimise: Seconds = 90.0
    """The time for the optimisation [s]. If it ends without an optimum, the best geometry seen is reported."""
    prove: Seconds = 40.0
    """The time for all proofs together [s]. A claim that is not decided by then is reported as undecided."""
    map: Seconds = 60.0
    """The time for a map [s]. The proof of its certified part gets the same time again."""

    @classmethod
    def each(cls, seconds: float) -> Self:
        """A budget with the same time for each stage [s]."""
        return cls(**dict.fromkeys(cls.model_fields, seconds))


class Study(StudyTable):
    """A whole study. `studies.building.load_study` reads one and checks it against its mechanism."""

    name: str
    """The folder's name."""
    title: Annotated[Name, Key("a title")]
    """The report's title."""
    mechanism: Annotated[str, Key("the name of a mechanism, or module:Class")]
    """The mechanism to study: a name, or `module:Class` of a module beside the study or on Python's path."""
    mechanism_class: Annotated[type[Mechanism], SkipValidation, Field(exclude=True, repr=False)]
    """The mechanism's class."""
    code: str = ""
    """SHA-256 of the file that defines the mechanism; "" for one of Linkwright's own."""
    geometry: Annotated[dict[str, GeometryValue], Field(default_factory=dict), Table({})]
    """The geometry, where it differs from the prototype's [m, rad, m per turn]."""
    inertia: Annotated[InertiaTable, Table({})] = InertiaTable()
    """The masses and drives, where they differ from the prototype's."""
    material: Annotated[dict[str, MaterialTable], Field(default_factory=dict), Table({})]
    """Materials of the study's own, by name."""
    structure: Annotated[StructureTable, Table({})] = StructureTable()
    """What the members are made of, where it differs from the prototype's."""
    load: Annotated[LoadTable, table_of(LoadTable)] = LoadTable()
    """The load that `natural_frequency` and `strength` are for."""
    ranges: Annotated[Ranges, Field(default_factory=dict), Table({})]
    """The joint ranges, where they differ from the prototype's."""
    surroundings: Annotated[SurroundingsTable, table_of(SurroundingsTable)] = SurroundingsTable()
    """What the robot must not touch besides itself."""
    region: Annotated[Annotated[BoxTable | CylinderTable, Field(discriminator="kind")], Table({})]
    """The workspace: the requirements must hold at every pose in it."""
    home: Annotated[HomeTable | None, table_of(HomeTable)] = None
    """The pose that the robot works around. None takes the middle of the region."""
    fvi: Annotated[FviTable | None, table_of(FviTable)] = None
    """The numbers of the force-velocity index (FVI). None takes the mechanism's own numbers."""
    optimise: Annotated[OptimiseTable | None, table_of(OptimiseTable)] = None
    """The variables of the optimisation. None keeps the given geometry."""
    dense_sample: Annotated[int, Field(ge=10_000, le=100_000_000), Key("a whole number from 10000 to 100000000")] = (
        DENSE
    )
    """The approximate number of poses of the dense search. It then descends from the lowest ones."""
    requirement: Annotated[tuple[RequirementTable, ...], table_of(RequirementTable, rows=True)] = ()
    """The requirements."""
    certify: Annotated[CertifyTable, table_of(CertifyTable)] = CertifyTable()
    """The proofs over the region."""
    trajectory: Annotated[TrajectoryTable | None, table_of(TrajectoryTable)] = None
    """The cycle or path to time. None times nothing."""
    budget: Annotated[BudgetTable, table_of(BudgetTable)] = BudgetTable()
    """How long each stage may take."""

    @property
    def digest(self) -> str:
        """SHA-256 (hex) of the whole study except its budget and its folder's name, in SI to 12 digits."""
        return digest_of(plain(self.model_dump(exclude={"name", "budget"}, exclude_defaults=True)))
