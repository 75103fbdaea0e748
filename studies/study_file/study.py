"""The study file: one question, asked in `study.toml`, as a frozen model in SI and radians."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, SkipValidation, model_validator

from kinematics import Mechanism
from studies.study_file.machine_tables import InertiaTable, Ranges
from studies.study_file.questions import digest_of, plain
from studies.study_file.table import Entry, Interval, Name, Positive, StudyTable, gathered, table_of
from studies.study_file.trajectory_tables import TrajectoryTable
from studies.study_file.units import Dimension, Key, Table

LENGTH = Dimension.LENGTH
Coordinate = float | Interval
GeometryValue = float | tuple[float, ...] | tuple[tuple[float, ...], ...]

REGION_KINDS = ("box", "cylinder")
KIND = Key("one of", choices=REGION_KINDS)


class _RegionTable(StudyTable):
    coordinates: dict[str, Coordinate]
    """By the pose's names: (low, high), or a number that fixes the coordinate [m or rad]."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return gathered(cls, data)


class BoxTable(_RegionTable):
    """Every pose coordinate in its interval."""

    kind: Annotated[Literal["box"], KIND]
    """With every coordinate of the pose beside it."""


class CylinderTable(_RegionTable):
    """x and y within `radius` [m] of the z axis; `coordinates` has the others."""

    kind: Annotated[Literal["cylinder"], KIND]
    """With every coordinate of the pose but x and y beside it."""
    radius: Annotated[Positive, Key("a length > 0", LENGTH)]
    """Of x and y about the z axis."""


class HomeTable(StudyTable):
    """The pose that the robot works around: its working mode follows from it, and an approach starts there."""

    coordinates: dict[str, float]
    """By the pose's names [m or rad]; one that is left out is in the middle of the region."""
    joints: Annotated[tuple[float, ...] | None, Key("a finite number a joint")] = None
    """About the joints at home, which choose a branch of each limb's inverse, such as elbows in; None for the usual."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return gathered(cls, data)


class FviTable(StudyTable):
    """What the force-velocity index (39) is taken from: what the joints give, what is wanted."""

    joint_speed: Annotated[Positive, Key("a speed > 0", Dimension.JOINT_SPEED)]
    """What each joint gives."""
    joint_effort: Annotated[Positive, Key("an effort > 0 (N m, or N on a rail)")]
    """What each joint gives."""
    speed: Annotated[Positive, Key("a speed > 0 (m/s)")]
    """Wanted worst isotropic speed [m/s]."""
    force: Annotated[Positive, Key("a force > 0 (N)")]
    """Wanted worst isotropic force [N]."""
    characteristic_length: Annotated[Positive | None, Key("a length > 0", LENGTH)] = None
    """Makes a rotation a length; None for the mechanism's own."""


class SumTable(StudyTable):
    """The geometry's `fields`, added, are `at_most` [m]."""

    fields: Annotated[Annotated[tuple[Name, ...], Field(min_length=1)], Key("a list out of")]
    """Lengths of the geometry, to be added; a tuple counts entry by entry."""
    at_most: Annotated[Positive, Key("a length > 0", LENGTH)]
    """The sum."""


class OptimiseTable(StudyTable):
    """What the synthesis may change."""

    seed: Annotated[int, Field(ge=0, lt=2**32), Key("a whole number from 0 to 2^32 - 1")] = 0
    """Of the random starts."""
    starts: Annotated[int, Field(ge=1, le=10_000), Key("a whole number from 1 to 10000")] = 3
    """Geometries to start from, the study's own first."""
    variables: Annotated[dict[str, Interval | tuple[Entry, ...]], Field(min_length=1), Table({})]
    """What may change, by field: (low, high), one for each entry of a tuple; an entry with low = high stays there."""
    sums: Annotated[tuple[SumTable, ...], table_of(SumTable, rows=True)] = ()
    """Limits of sums of lengths."""


class RequirementTable(StudyTable):
    """`margin` is `at_least` this at every pose of the region."""

    margin: Annotated[str, Key("one of")]
    """What is required."""
    at_least: Annotated[float, Key("a finite number, of reach 0 or more")]
    """At every pose of the region and on the cycle."""


class CertifyTable(StudyTable):
    """What is proved of every pose: each required margin at its bound, the objective and any other at its best."""

    margins: Annotated[tuple[Name, ...] | None, Key("a list out of")] = None
    """None for all that are required, and the objective."""
    tolerance: Annotated[Positive, Field(lt=1), Key("a number above 0 and below 1")] = 0.01
    """By how much a best bound may stay below the lowest value found, relative to that value."""
    most_boxes: Annotated[int, Field(ge=4, le=8_000_000), Key("a whole number from 4 to 8000000")] = 4_000_000
    """After so many a claim stays undecided."""


Seconds = Annotated[Positive, Key("a time > 0 (s)")]


class BudgetTable(StudyTable):
    """How long a stage may take; what it has reached by then stands, and is reported."""

    optimise: Seconds = 90.0
    """Of the search for the best geometry [s]; one that is not found by then is none, and the best seen is told."""
    prove: Seconds = 40.0
    """Of all claims together [s]; what is not decided by then is reported as undecided."""
    map: Seconds = 60.0
    """Of a map, and of its certified part [s]."""

    @classmethod
    def each(cls, seconds: float) -> Self:
        """The same for each stage."""
        return cls(**dict.fromkeys(cls.model_fields, seconds))


class Study(StudyTable):
    """A whole study; `studies.load.load_study` reads one and checks it against its mechanism."""

    name: str
    """The folder's name."""
    title: Annotated[Name, Key("a title")]
    """Of the report."""
    mechanism: Annotated[str, Key("the name of a mechanism, or module:Class")]
    """The mechanism to study: a name, or `module:Class` of a module beside the study or on Python's path."""
    mechanism_class: Annotated[type[Mechanism], SkipValidation, Field(exclude=True, repr=False)]
    """Its class."""
    code: str = ""
    """SHA-256 of the file that defines the mechanism; "" for one of Linkwright's own."""
    geometry: Annotated[dict[str, GeometryValue], Field(default_factory=dict), Table({})]
    """What differs from the prototype's geometry [m, rad, m per turn]."""
    inertia: Annotated[InertiaTable, Table({})] = InertiaTable()
    """What differs from the prototype's masses and drives."""
    ranges: Annotated[Ranges, Field(default_factory=dict), Table({})]
    """What differs from the prototype's joint ranges."""
    region: Annotated[Annotated[BoxTable | CylinderTable, Field(discriminator="kind")], Table({})]
    """The workspace: every pose that is to be good."""
    home: Annotated[HomeTable | None, table_of(HomeTable)] = None
    """The pose that the robot works around; None for the middle of the region."""
    fvi: Annotated[FviTable | None, table_of(FviTable)] = None
    """What the FVI is taken from; None for the mechanism's own."""
    optimise: Annotated[OptimiseTable | None, table_of(OptimiseTable)] = None
    """What the synthesis may change; None for the geometry as it is given."""
    dense_sample: Annotated[int, Field(ge=10_000, le=100_000_000), Key("a whole number from 10000 to 100000000")] = (
        1_000_000
    )
    """About how many poses of the region the worst cases are searched on, before the descents."""
    requirement: Annotated[tuple[RequirementTable, ...], table_of(RequirementTable, rows=True)] = ()
    """What must hold."""
    certify: Annotated[CertifyTable, table_of(CertifyTable)] = CertifyTable()
    """What is proved."""
    trajectory: Annotated[TrajectoryTable | None, table_of(TrajectoryTable)] = None
    """What is timed; None for no cycle."""
    budget: Annotated[BudgetTable, table_of(BudgetTable)] = BudgetTable()
    """How long each stage may take."""

    @property
    def digest(self) -> str:
        """sha256 (hex) of all that the file says but its budget, in SI to 12 digits; without its folder's name."""
        return digest_of(plain(self.model_dump(exclude={"name", "budget"}, exclude_defaults=True)))
