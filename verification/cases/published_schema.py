"""Schema of the TOML file of a published case."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from verification.cases.toml_file import Friction, Poisson, Positive, Strict, Text
from verification.cases.unit_numbers import Metres, Newtons, Pascals

Cells = Annotated[dict[str, str | float], Field(max_length=20)]


class LayerEntry(Strict):
    """A material; a coating with its thickness too."""

    E: Pascals
    nu: Poisson
    thickness: Metres | None = None
    thickness_over_a_h: Positive | None = None


class PublishedBall(Strict):
    """An elastic ball in the units of the source; its coatings from its surface inwards."""

    E: Pascals
    nu: Poisson
    coatings: Annotated[list[LayerEntry], Field(default_factory=list, max_length=50)]


class ProblemEntry(Strict):
    """A uniform disc or a sphere on a layered solid, in the units of the source.

    A text with a unit of its own, "210 GPa", is in that.

    A sphere without a load follows a loading curve, to the positions of the tables.
    """

    length_unit: Text
    stress_unit: Text
    load_unit: Text = "N"
    substrate: LayerEntry
    coatings: Annotated[list[LayerEntry], Field(default_factory=list, max_length=50)]
    ball: PublishedBall | None = None
    friction: Friction = 0.0
    pressure: Pascals | None = None
    load_radius: Metres | None = None
    radius: Metres | None = None
    load: Newtons | None = None

    @model_validator(mode="after")
    def _disc_or_sphere(self) -> "ProblemEntry":
        disc = (self.pressure is not None) + (self.load_radius is not None)
        sphere = (self.radius is not None) + (self.load is not None)
        if (disc, sphere) not in ((2, 0), (0, 2)) and not (disc == 0 and self.load is None and self.radius):
            fit = "pressure and load_radius (a uniform disc), radius and load (a sphere)"
            raise ValueError(f"needs {fit}, or radius alone (a loading curve)")
        if self.load is None and self.friction and disc == 0:
            raise ValueError("friction belongs to a disc, or to a sphere under a load")
        if self.load is None and self.ball is not None:
            raise ValueError("an elastic ball needs a radius and a load")
        return self


class PositionEntry(Strict):
    """Positions of values: numbers or names of columns, in ``unit``; ``layer`` picks a side of an interface.

    contact_radius, approach : on a loading curve, one of them in place of x, y, z.
    """

    x: str | float = 0.0
    y: str | float = 0.0
    z: str | float = 0.0
    contact_radius: str | float | None = None
    approach: str | float | None = None
    unit: Text
    layer: Annotated[int, Field(ge=0)] | None = None


class ColumnEntry(Strict):
    """A column of a table: ``quantity`` = ``factor`` times the published number, in ``unit``.

    uncertainty : of digitisation, in that unit; otherwise half of the last digit of the column, or of the
    last of ``significant`` digits of each cell.
    series : coefficients c1, c2, .. of a power series whose ratio to the exact solution is published.

    A column ``name_departure`` beside it lists the departures of the source: exact solution less published
    number, in the same unit and sign; empty where the number is correct.
    """

    name: Text
    quantity: Text
    unit: Text
    factor: float = 1.0
    at: PositionEntry | None = None
    uncertainty: Positive | None = None
    significant: Annotated[int, Field(ge=1, le=16)] | None = None
    series: Annotated[list[float], Field(default_factory=list, max_length=20)]


class CeilingEntry(Strict):
    """Largest admissible uncertainty of a cell as a fraction of the scale, with the reason ``why``."""

    fraction: Annotated[float, Field(gt=0, lt=1)]
    why: Text


class TableEntry(Strict):
    """One CSV file with the rows selected and their columns.

    seen : what was seen of the source; ``read``, in which document or by which formula.
    label : a column that names rows.   ceiling : where the source supports less than 1 %.
    """

    file: Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]+\.csv$")]
    seen: Literal["primary", "second source", "quoted", "recomputed"]
    read: Text
    at: PositionEntry | None = None
    rows: Cells = Field(default_factory=dict)
    label: Text | None = None
    ceiling: CeilingEntry | None = None
    column: Annotated[list[ColumnEntry], Field(min_length=1, max_length=100)]


class PublishedFile(Strict):
    """The TOML file of a published case."""

    title: Text
    source: Text
    year: Annotated[int, Field(ge=1600, le=2100)]
    remark: Annotated[str, Field(max_length=2000)] = ""
    problem: ProblemEntry
    table: Annotated[list[TableEntry], Field(min_length=1, max_length=100)]
