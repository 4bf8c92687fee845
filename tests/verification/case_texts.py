"""Text of a case file, for tests that change a part of it."""


def case_text(*coatings, title="Stiff coating", radius="10e-3", load="20", E="210e9", more="", tables=""):
    """A sphere on steel under ``coatings``, each its keys parted by "; ".

    more : further keys of the problem, parted by "; ".   tables : what follows the problem.
    """
    lines = [f'title = "{title}"', "[problem]", f"radius = {radius}", f"load = {load}"]
    lines += [f"substrate = {{ E = {E}, nu = 0.3 }}", *filter(None, more.split("; "))]
    for coating in coatings:
        lines += ["[[problem.coatings]]", *coating.split("; ")]
    return "\n".join(lines) + "\n" + tables


def study_text(*problem, sweep, title="Mine", radius="10e-3", load="20.0", tables=""):
    """A study of coatings on steel under a sphere; ``sweep`` its keys parted by "; ".

    problem : further keys, such as the coating.   load : "" where it is swept.   tables : what follows.
    """
    lines = [f'title = "{title}"', "[problem]", *([f"radius = {radius}"] if radius else [])]
    lines += [f"load = {load}"] * bool(load) + ["substrate = { E = 210e9, nu = 0.3 }", *problem]
    return "\n".join([*lines, "[sweep]", *sweep.split("; ")]) + "\n" + tables
