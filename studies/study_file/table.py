"""The base of every table of a study file: a strict frozen model, kinds of values, and the keys of a table."""

from collections.abc import Collection
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from studies.study_file.keys import Key, Table


def _rising(pair: tuple[float, float]) -> tuple[float, float]:
    if pair[0] >= pair[1]:
        raise ValueError("low must be below high")
    return pair


def _not_falling(pair: tuple[float, float]) -> tuple[float, float]:
    if pair[0] > pair[1]:
        raise ValueError("low must not be above high")
    return pair


Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Interval = Annotated[tuple[float, float], AfterValidator(_rising)]
Entry = Annotated[tuple[float, float], AfterValidator(_not_falling)]
PerJoint = Positive | Annotated[tuple[Positive, ...], Field(min_length=1)]
Name = Annotated[str, Field(min_length=1)]


def one_of(choices: Collection[str]) -> AfterValidator:
    """A check that a word is one of the choices."""

    def check(word: str) -> str:
        if word not in choices:
            raise ValueError("no such choice")
        return word

    return AfterValidator(check)


class StudyTable(BaseModel):
    """A table of the file. It accepts only its fields, only finite numbers, and converts no type."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )


def table_of(model: type[BaseModel], rows: bool = False) -> Table:
    """The keys that `model` takes from a file: its fields with a Key or a Table in their annotation."""
    keys = {
        name: node
        for name, field in model.model_fields.items()
        for node in field.metadata
        if isinstance(node, Key | Table)
    }
    return Table(keys, rows)


def gathered(model: type[BaseModel], data: Any, name: str = "coordinates") -> Any:
    """The `data` of a file; keys that are not the model's own are moved into its field `name`."""
    if not isinstance(data, dict) or name in data:
        return data
    own = {key: value for key, value in data.items() if key in model.model_fields}
    return own | {name: {key: data[key] for key in data if key not in own}}
