"""Schema of the open digits, which the package holds as ``vectors.schema.json``."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class Material(_Strict):
    """Young's modulus [Pa], Poisson's ratio, thickness [m] of a coating."""

    E: float
    nu: float
    thickness: float | None = None


class Solid(_Strict):
    """Coatings of an elastic ball from its surface inwards, and the material below them."""

    coatings: list[Material]
    substrate: Material


class Entry(_Strict):
    """Radius [m] and load [N] of a sphere, radii and load of an ellipsoid, or pressure [Pa] on a disc.

    The sphere is rigid unless there is a ``ball``.
    """

    radius: float | None = None
    radius_x: float | None = None
    radius_y: float | None = None
    load: float | None = None
    pressure: float | None = None
    load_radius: float | None = None
    friction: float = 0.0
    coatings: list[Material]
    substrate: Material
    ball: Solid | None = None


class Points(_Strict):
    """Values at points in one layer of a body; as many of each as x, y and z."""

    body: Literal["flat", "ball"]
    layer: int
    x: list[float]
    y: list[float]
    z: list[float]
    values: dict[str, list[float]]
    uncertainty: dict[str, list[float]]


class Vector(_Strict):
    """One problem with its values: numbers of the contact as [value, uncertainty], then points."""

    name: str
    group: str
    problem: Entry
    contact: dict[str, tuple[float, float]]
    points: list[Points]


class Checked(_Strict):
    """How many ``values`` of how many ``problems`` a ``method`` gave, and how many lie ``within`` both U.

    of : which values were compared.
    """

    method: str
    of: str
    problems: int
    values: int
    within: int
    largest_share_of_U: float
    refused: list[str] = Field(default_factory=list)


class Cite(_Strict):
    """How the values are cited."""

    authors: str
    title: str
    version: str
    date: str
    licence: str


class VectorSet(_Strict):
    """The whole data set; ``sha256`` are the checksums of the CSV files of the same content."""

    schema_: Literal["coatcheck-vectors/2"] = Field(alias="schema")
    licence: Literal["CC0-1.0"]
    cite: Cite
    conventions: dict[str, str]
    made_by: dict[str, str]
    checked: list[Checked]
    sha256: dict[str, str]
    problems: list[Vector]
