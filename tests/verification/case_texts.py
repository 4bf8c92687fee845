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
