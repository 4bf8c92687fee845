"""Mutation testing: score of each room, survivors with the reason of each."""

from verification.evidence.mutant_record import REQUIRED, Catch, MutantRecord
from verification.page.number_text import plain, seconds
from verification.page.page_parts import Part, Section, Table, row, table_of, words
from verification.report.report_material import Material


def mutants_message(record: MutantRecord) -> str:
    """The score as a message."""
    caught, count = record.score()
    return (
        f"{caught} of {count} mutants are caught ({plain(100 * caught / max(count, 1), 3)} %), "
        f"{len(record.trials) - count} equivalent ones apart."
    )


def section(material: Material) -> Section | None:
    """The mutants on record; None without a record."""
    record = material.evidence.mutants
    if record is None:
        return None
    method = (
        "One operator, constant, index or term of the source is changed at a time, at places drawn at "
        "random, as many in each room. Each mutant meets the checks of the default run, the self-tests, then "
        f"the unit tests of its room. {mutants_message(record)} Measured {record.info.started[:10]}, commit "
        f"{record.info.commit or 'unknown'}, {seconds(record.seconds)} on one core. Only equivalent mutants, "
        "which change no result, are left out of the share."
    )
    shown = [catch for catch in Catch if any(trial.catch is catch for trial in record.trials)]
    scores = []
    for name, required in REQUIRED.items():
        caught, count = record.score(name)
        if count:
            by = [sum((t.room, t.catch) == (name, catch) for t in record.trials) for catch in shown]
            share = f"{plain(100 * caught / count, 3)} %, {plain(100 * required, 3)} % required"
            scores.append(row(name, *by, words(share)))
    parts = [Part(method, [Table("Mutants of each room.", ["room", *map(str, shown), "caught"], scores)])]
    if record.survivors:
        survivors = table_of(
            "Survivors.",
            record.survivors,
            [
                ("place", lambda pair: f"{pair[1].file}:{pair[1].line}"),
                ("function", lambda pair: words(pair[1].function)),
                ("change", lambda pair: words(pair[1].change)),
                ("kind", lambda pair: words(pair[0].kind or "not read")),
                ("reason", lambda pair: words(pair[0].reason)),
            ],
        )
        parts.append(Part("Mutants that nothing caught.", [survivors]))
    return Section("mutants", "Mutation testing", parts)
