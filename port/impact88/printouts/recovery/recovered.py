"""Recovering the scene of a printout: the one whose page explains the paper at the least cost.

A printed field says most of what an input may have been; a reply at the prompt bears it out, or
speaks where the field is lost. A clean number is not doubted here: its misreadings are `slips`'.
Inputs that nothing determines have stand-ins, and only what does not depend on them is kept for
comparison.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ...cases.case import MAX_TYPED
from ...names import SCENE
from ..fields import ANGLES, FIELDS, FINAL_SPINS, INPUTS, scene_name
from ..reading.glyphs import letters
from ..reading.numerals import candidates
from ..reading.printout import Printout, Reading
from . import replays
from .search import MISMATCH, UNREAD, Column, Evidence, Expected, Search, column_of
from .slips import neighbours
from .typedtext import stored_and_printed

_STAND_INS = tuple(
    "1.7 230 -41000 -.4 0 .5 -1 1 -.75 .25 12.5 -33 61 90 -118 164 3.1 -7.7 2900".split()
)
"""Values put in place of inputs that nothing determines, of the sizes of coefficients, arms, angles
in all quarters, velocities and masses: a field that prints the same with each of them does not
depend on the input. Where friction reverses, values far apart may print alike and others not."""
MAX_TEXTS = 40  # candidate texts of one input
MAX_RESULT_TEXTS = 60  # candidate texts of one result
REPLY_MISMATCH = 1.0
"""Penalty where a printed number and its reply disagree, or only the reply was read."""
PROMPT_MARK_READINGS = "7291?P"
"""Characters that the prompt's question mark is read as."""
MAX_WRONG_RESULTS = 3
"""Differing results up to which a guess counts (the row of angles, or a number without a legible
character); with more, the guessed input counts as missing."""


@dataclass
class Recovered:
    """The scene that a printout shows.

    Parameters
    ----------
    scene : dict of str to str
        The inputs as typed; stand-ins for those in ``missing``.
    assumed : dict of str to str
        The printed texts that the scene goes with, by field.
    outcome : Outcome
        What the replay prints, without fields that depend on missing inputs.
    missing : list of str
        Inputs that nothing on the page determines.
    wrong : frozenset of str
        Names of the fields that the scene leaves unexplained.
    search : Search
        The search that found it.
    m_unknown : bool
        True if M = 4 explains the page as well as M = 6.
    row_in_doubt : bool
        True if the row of angles was read uncertainly and no reading of it explains the page.
    typed : dict of str to str
        The texts typed for inputs that a copy of the listing converts before it prints them.
    """

    scene: dict[str, str]
    assumed: dict[str, str]
    outcome: replays.Outcome
    missing: list[str]
    wrong: frozenset[str]
    search: Search
    m_unknown: bool = False
    row_in_doubt: bool = False
    typed: dict[str, str] = field(default_factory=dict)

    @property
    def apart(self) -> list[str]:
        """Fields of the inputs given separately: neither on the page nor missing."""
        excluded = {*self.assumed, *self.missing}
        return [
            name for name in INPUTS if name not in excluded and scene_name(name) not in excluded
        ]

    def scene_or_missing(self) -> dict[str, str | None]:
        """Return the scene in the table's order, with None for missing inputs."""
        return {name: None if name in self.missing else self.scene[name] for name in SCENE}


def recover(shown: Printout, given: Mapping[str, str] | None = None) -> Recovered:
    """Return the scene whose page explains the printout best. ``given``: inputs known from
    elsewhere, by scene name."""
    given = given or {}
    columns, typed, lost = _choices(shown, given)
    search = Search(_evidence(shown, typed))
    best = search.best(columns)
    unconvincing = len(best.wrong) > MAX_WRONG_RESULTS
    cut = {scene_name(name) for name in shown.fields if name in INPUTS and shown.fields[name].cut}
    lost |= cut - set(given) if best.wrong else set()
    if unconvincing:  # a mark for illegible text may stand for any number of characters
        marks = (
            name for name, field in shown.fields.items() if set(letters(field.region)) == {"?"}
        )
        lost |= {scene_name(name) for name in marks if name in INPUTS} - set(given)
    missing = [name for name in map(scene_name, INPUTS) if name in lost]
    outcome = _independent_of(missing, best.scene, best.outcome) if missing else best.outcome
    m_unknown = not (missing or shown.has_final_spins or shown.ending)
    if m_unknown and not shown.fragment_of_run:
        # the other M may print the same but for the final spins
        other_m = replays.run_once({**best.scene, "M": "6" if best.scene["M"] == "4" else "4"})
        m_unknown = all(
            other_m.fields.get(name) == text
            for name, text in best.outcome.fields.items()
            if name in other_m.fields and name not in FINAL_SPINS
        )
    in_doubt = bool(shown.angles) and unconvincing and not lost & set(ANGLES)
    return Recovered(
        best.scene, best.assumed, outcome, missing, best.wrong, search, m_unknown, in_doubt
    )


def _evidence(shown: Printout, typed: Mapping[str, Mapping[str, str]]) -> Evidence:
    """Return a printout read from a text as evidence."""
    results = []
    for name in FIELDS:
        if name not in INPUTS and (reading := shown.fields.get(name)):
            legible = reading.clean or sum(map(str.isdigit, letters(reading.region))) >= 2
            default = MISMATCH if legible else UNREAD
            results.append(Expected(name, reading.texts(MAX_RESULT_TEXTS), default))
    inputs = {*INPUTS} & {*shown.fields, *(ANGLES if shown.angles else ())}
    return Evidence(results, inputs, typed, shown.ending, shown.has_final_spins)


def without_angles(recovered: Recovered) -> Recovered:
    """Return the scene with the row of angles counted as missing."""
    missing = [*recovered.missing, *ANGLES]
    outcome = _independent_of(missing, recovered.scene, recovered.outcome)
    return replace(recovered, missing=missing, outcome=outcome, m_unknown=False, row_in_doubt=False)


def _independent_of(
    lost: list[str], scene: Mapping[str, str], outcome: replays.Outcome
) -> replays.Outcome:
    """Return the outcome's fields that are the same whatever the missing inputs are."""
    count = len(_STAND_INS)
    scenes = [
        {**scene, **{name: _STAND_INS[(k + 5 * at) % count] for at, name in enumerate(lost)}}
        for k in range(count)
    ]
    fields = {name: text for name, text in outcome.fields.items() if scene_name(name) not in lost}
    for variant in replays.run_all(scenes):
        if variant.ending in (None, outcome.ending):
            fields = {
                name: text for name, text in fields.items() if variant.fields.get(name) == text
            }
    return replays.Outcome(fields, None)


def _choices(
    shown: Printout, given: Mapping[str, str]
) -> tuple[list[Column], dict[str, dict[str, str]], set[str]]:
    """Return the candidate texts of each input; by field, the text typed for a printed text, where
    a reply or a scene file says so; and the names of inputs that nothing determines."""
    columns, typed, missing = [], {}, set()
    single_inputs = list(INPUTS)
    if shown.angles and given.keys().isdisjoint(ANGLES):
        columns.append(Column(ANGLES, _rows_of_angles(shown)))
        single_inputs = [name for name in INPUTS if name not in ANGLES]
    for name in single_inputs:
        scene = scene_name(name)
        texts, typed[name] = _candidates(name, shown)
        if scene in given:
            printed = (stored_and_printed(given[scene], name in ANGLES) or ("", ""))[1]
            if name in shown.fields and printed in texts:
                texts, typed[name] = {printed: texts[printed]}, {printed: given[scene]}
            elif name not in shown.fields or not texts:
                texts, typed[name] = {given[scene]: 0.0}, {given[scene]: given[scene]}
        if not texts:
            missing.add(scene)
            texts = {_STAND_INS[0]: 0.0}
        options = sorted(texts.items(), key=lambda option: option[1])[:MAX_TEXTS]
        columns.append(column_of(name, options))
    ms = [("4", 0.0), ("6", 0.5 if shown.ended else 0.1)]
    if "M" in given or shown.has_final_spins:
        ms = [(given.get("M", "6"), 0.0)]
    return [*columns, column_of("M", ms, True)], typed, missing


def _rows_of_angles(shown: Printout) -> list[tuple[tuple[str, ...], float]]:
    """Return the texts that a row of angles may be; and those one slip away from the likeliest,
    where no machine read the page: a machine damages a row in more ways than a slip."""
    rows = {row.texts: row.cost for row in shown.angles}
    if shown.machine_read:
        return [*rows.items()]
    row, least, _ = shown.angles[0]
    for at, (name, text) in enumerate(zip(ANGLES, row, strict=True)):
        for would_be, cost in neighbours(name, text).items():
            other = (*row[:at], would_be, *row[at + 1 :])
            rows[other] = min(least + cost, rows.get(other, least + cost))
    return sorted(rows.items(), key=lambda option: option[1])


def _candidates(name: str, shown: Printout) -> tuple[dict[str, float], dict[str, str]]:
    """Return the texts that may be printed for an input, with their penalties; and the texts typed
    for those that its reply confirms."""
    reading, reply = shown.fields.get(name), shown.replies.get(name)
    own = reading.texts(MAX_TEXTS) if reading else {}
    answers = reply_candidates(reply) if reply else []
    disagrees = REPLY_MISMATCH if own and answers else 0.0
    texts = {text: cost + disagrees for text, cost in own.items()}
    typed: dict[str, str] = {}
    for answer, printed, price in sorted(answers, key=lambda candidate: candidate[2]):
        if printed not in typed:
            typed[printed] = answer
            if printed in own:
                texts[printed] += 0.3 * price - disagrees
            elif reading is None or not reading.clean:
                texts[printed] = REPLY_MISMATCH + price + disagrees
    return texts, typed


def without_mark(reply: Reading) -> Reading | None:
    """Return a reply without its first glyph; None unless that may be the prompt's own question
    mark."""
    if reply.region[0].char not in PROMPT_MARK_READINGS or len(reply.region) < 2:
        return None
    return replace(reply, text=reply.text[1:], region=reply.region[1:])


def reply_candidates(reply: Reading) -> list[tuple[str, str, float]]:
    """Return the candidates for a reply at a prompt: the text typed, the text that it prints as,
    and its penalty. The prompt's own question mark may have been read as a first digit."""
    penalties: dict[str, float] = {}
    for reading, cost in ((reply, 0.0), (without_mark(reply), 0.5)):
        if reading is not None:
            clean = {reading.text: 0.0}
            texts = clean if reading.clean else dict(candidates(reading.region, 8))
            penalties = {text: cost + price for text, price in texts.items()} | penalties
    return [
        (text, seen[1], cost)
        for text, cost in penalties.items()
        if len(text) <= MAX_TYPED and (seen := stored_and_printed(text)) is not None
    ]
