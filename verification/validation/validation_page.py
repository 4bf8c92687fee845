"""Pages about the comparison with measurements: a section of the report and a page of its own."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from verification.page.figures import ROLES, inline, written
from verification.page.html_page import render_sections
from verification.page.page_parts import Gallery, Panel, Part, Section, Table, number, row, words
from verification.problem.array_types import Array
from verification.sources.references.layered_half_space import contact_modulus
from verification.validation.measured_modulus import described
from verification.validation.validation_metric import (
    RECORD,
    Validated,
    ValidationRecord,
    exact_modulus,
    substrate,
)

SHIPPED = Path(__file__).parent / "shipped"
NOT_YET = (
    "No stress, no friction, no contact that is not round and no imaged contact radius has been compared "
    "with a measurement. Reported, not judged: no verdict and no exit code depends on this."
)


def _percent(value: float) -> str:
    return f"{100 * value:+.1f} %".replace("-", "−")


def _signed(value: float) -> str:
    return f"{value:+.2f}".replace("-", "−")


def _size(value: float) -> str:
    return f"{100 * value:.2g} %"


def answer(found: Validated) -> str:
    """The comparison in one sentence, with its uncertainty."""
    low, high = found.interval
    film, bare = (np.abs(ends / found.u_val).max() for ends in (found.bare_film, found.bare_substrate))
    discriminate = "discriminate" if min(film, bare) > 2 else "do not discriminate"
    return (
        f"{found.measured.title}: the computed modulus differs from the measured one by "
        f"{_percent(found.mean)} in the mean of {len(found.E)} rows and {_size(found.rms)} rms, with u_val "
        f"= {_size(found.u_val.mean())}; the model's error lies between {_percent(low)} and "
        f"{_percent(high)}. The data {discriminate}: the bare film is off by up to {film:.1f} u_val, the "
        f"bare substrate by up to {bare:.1f}."
    )


def section(record: ValidationRecord) -> Section:
    """Every data set with its numbers, assumptions and, where it is not admissible, the reason."""
    admissible = [one for one in record.sets if not one.measured.reason]
    parts = [
        Part(
            "Measured is the contact stiffness of coated wafers by continuous-stiffness indentation. It "
            "depends on the contact radius and the layers alone, not on the shape of the tip, so that a "
            "plastic imprint tests the layered compliance too. E = S − D is the difference between "
            f"simulation and data, u_val its standard uncertainty (ASME V&V 20-2009). {NOT_YET}"
        ),
        Part("", [_summary(record)]),
        *(part for one in admissible for part in _details(one)),
        Part("", [_not_compared()]),
    ]
    return Section("validation", "Held against measurement", parts)


def _summary(record: ValidationRecord) -> Table:
    heads = ["data", "rows", "mean E", "rms E", "u_num", "u_input", "u_D", "u_val", "largest |E|"]
    heads += ["bare film", "bare substrate", "admissible"]
    rows = []
    for one in record.sets:
        u = one.u_val
        shares = (np.max(one.u_num), one.u_input.mean(), one.u_D.mean(), u.mean())
        ends = [np.abs(values / u).max() for values in (one.E, one.bare_film, one.bare_substrate)]
        rows.append(
            row(
                words(one.measured.title),
                number(float(len(one.E)), "{:.0f}".format),
                number(one.mean, _percent),
                number(one.rms, _size),
                *(number(float(share), _size) for share in shares),
                *(number(float(end), "{:.1f}".format) for end in ends),
                "no" if one.measured.reason else "yes",
            )
        )
    caption = (
        "Relative to the measured modulus; u_input, u_D, u_val: mean over the rows. Over u_val: largest |E|, "
        "bare film, bare substrate. All rows of a set share systematic errors and are not "
        "independent tests."
    )
    return Table(caption, heads, rows)


def _details(one: Validated) -> list[Part]:
    data, rows = one.measured, np.flatnonzero(one.measured.admitted)
    elements = dict(one.elements)
    table = Table(
        "Moduli S/(2a) [GPa]; E relative to D",
        [
            "a [nm]",
            "a/t",
            "D",
            "S, semi-analytical",
            "S, finite elements",
            "E",
            "u_random",
            "u_val",
            "E/u_val",
        ],
        [
            row(
                number(data.a[k] * 1e9, "{:.1f}".format),
                number(data.a[k] / data.layers[0].thickness, "{:.2f}".format),
                number(data.D[k] / 1e9, "{:.2f}".format),
                number(one.S[i] / 1e9, "{:.3f}".format),
                number(elements[i] / 1e9 if i in elements else None, "{:.3f}".format),
                number(one.E[i], _percent),
                number(one.u_random[i], _size),
                number(float(one.u_val[i]), _size),
                number(float(one.E[i] / one.u_val[i]), _signed),
            )
            for i, k in enumerate(rows)
        ],
    )
    basis = {
        f"{word} of {layer.name}": layer.basis for layer in data.layers for word in ("E", "nu", "thickness")
    }
    basis["modulus of the substrate"] = described()["substrate"]["basis"]
    inputs = Table(
        "Inputs, taken as independent: what one standard uncertainty of each changes, at most",
        ["input", "change of S", "basis"],
        [
            row(name, number(float(np.abs(change).max()), _size), words(basis[name]))
            for name, change in one.inputs.items()
        ]
        + [
            row(
                "area function and beta, shared by all rows (u_common)",
                number(one.u_common, _size),
                words("scatter of the bare wafer's modulus with depth; beta: other authors"),
            )
        ],
    )
    figure = Panel("Modulus against contact radius over film thickness", _drawn(one), "", "wide")
    errors = {
        name: _size(float(np.sqrt(np.mean((M / data.D[rows] - 1) ** 2))))
        for name, M in _of_formulas(one, data.a[rows]).items()
    }
    formulas = ", ".join(f"{name} by {error}" for name, error in errors.items())
    caption = f"{data.source}. Compared: {data.because} Assumed: {data.assumed}. In these rows formulas in "
    caption += f"common use are off: {formulas} rms."
    return [Part(answer(one), [table], Gallery([], [figure], caption), data.title), Part("", [inputs])]


def _not_compared() -> Table:
    found = [one for kind in ("set", "excluded", "seen") for one in described()[kind] if "reason" in one]
    rows = [row(words(one["title"]), words(one["reason"]), words(one["source"])) for one in found]
    return Table("Measurements not admissible, or not to be had", ["measurement", "reason", "source"], rows)


def common_formulas(a: Array, t: float, film: float, base: float, nu: float) -> dict[str, Array]:
    """Plane strain moduli [Pa] that formulas in common use give a film of thickness t [m] at radius a [m].

    Gao, Chiu and Lee (1992) with their weight I_0 of the moduli, linear in it, and Bec et al. (2006):

        M = M_s + (M_f - M_s) I_0,   1/M = 2 a/(1 + 2 t/(pi a)) (t/(pi a^2 M_f) + 1/(2 a M_s)),
        I_0 = (2/pi) arctan x + ((1 - 2 nu) x ln(1 + 1/x^2) - x/(1 + x^2)) / (2 pi (1 - nu)),   x = t/a

    film, base : M_f and M_s.   nu : of the film.
    """
    x = t / a
    weight = ((1 - 2 * nu) * x * np.log1p(1 / x**2) - x / (1 + x**2)) / (2 * np.pi * (1 - nu))
    weight += 2 / np.pi * np.arctan(x)
    compliance = 2 * a / (1 + 2 * x / np.pi) * (t / (np.pi * a**2 * film) + 1 / (2 * a * base))
    return {"Gao et al. 1992": base + (film - base) * weight, "Bec et al. 2006": 1 / compliance}


def _of_formulas(one: Validated, a: Array) -> dict[str, Array]:
    layer, solid = one.measured.layers[0], (one.measured.coatings, substrate())
    moduli = contact_modulus(*solid), contact_modulus((), substrate())
    return common_formulas(a, layer.thickness, *moduli, layer.nu)


def _drawn(one: Validated) -> Markup:
    data, film = one.measured, one.measured.layers[0]
    base = contact_modulus((), substrate())
    solid, t = (data.coatings, substrate()), film.thickness
    a = np.geomspace(0.8 * data.a.min(), 1.2 * data.a.max(), 60)
    exact = np.array([exact_modulus(radius, solid) for radius in a]) / 1e9
    band = np.interp(a, data.a[data.admitted], one.u_input)
    with mpl.rc_context({"font.size": 8}):
        figure = Figure(figsize=(6.4, 3.6), layout="constrained")
        axes = figure.subplots()
        axes.fill_between(
            a / t, exact * (1 - band), exact * (1 + band), color=ROLES["semi"], alpha=0.25, lw=0
        )
        axes.plot(a / t, exact, color=ROLES["semi"], label=r"layers, with $u_\mathrm{input}$")
        for (name, moduli), style in zip(_of_formulas(one, a).items(), ("--", "-."), strict=True):
            axes.plot(a / t, moduli / 1e9, color=ROLES["fem"], ls=style, lw=0.9, label=name)
        for value, name in ((contact_modulus(*solid), "bare film"), (base, "bare substrate")):
            axes.axhline(value / 1e9, color=ROLES["zone"], lw=0.8, ls=":")
            axes.annotate(
                name, (0.75, value / 1e9), ha="right", va="bottom", xycoords=("axes fraction", "data")
            )
        u_D = np.hypot(np.hypot(data.u_random, data.u_radius), data.u_common)
        for rows, colour, label in (
            (data.admitted, ROLES["ink"], r"measured, $u_\mathrm{D}$"),
            (~data.admitted, ROLES["zone"], "not compared"),
        ):
            bars = 1e-9 * (u_D * data.D)[rows]
            axes.errorbar(
                data.a[rows] / t, data.D[rows] / 1e9, bars, fmt="o", ms=3, lw=0.8, color=colour, label=label
            )
        inside = data.a[data.admitted] / t
        for low, high, why in ((a[0] / t, inside.min(), "tip"), (inside.max(), a[-1] / t, "plastic imprint")):
            axes.axvspan(low, high, color=ROLES["zone"], alpha=0.13, lw=0, zorder=0)
            axes.annotate(why, (np.sqrt(low * high), 0.02), xycoords=("data", "axes fraction"), ha="center")
        axes.set(xscale="log", xlim=(a[0] / t, a[-1] / t), xlabel="a / t", ylabel="S / (2a) [GPa]")
        figure.legend(frameon=False, loc="outside upper center", ncols=5, columnspacing=1, handlelength=1.5)
        return inline(written(figure), answer(one), css="print")


def page(record: ValidationRecord) -> str:
    """One HTML text that needs nothing else."""
    best = next(one for one in record.sets if not one.measured.reason)
    summary = (
        f"{best.measured.title}: computed and measured modulus differ by {_percent(best.mean)}, with a "
        f"standard uncertainty of {_size(best.u_val.mean())}"
    )
    facts = [
        ("Data sets", str(len(record.sets) + len(described()["excluded"]))),
        ("Computed", record.started),
        ("Commit", record.commit or "not known"),
    ]
    return render_sections("coatcheck validation", summary, facts, [section(record)])


def shipped() -> ValidationRecord | None:
    """The comparison as the package holds it; None where it was not computed."""
    return RECORD.read(SHIPPED)
