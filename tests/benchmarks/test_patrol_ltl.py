"""The patrol's properties of runs, decided here and by SPIN on the same model."""

from pathlib import Path

import pytest
from scripts import script

from checker import check
from specs import parse_bytes
from specs.elaboration import elaborate

patrol = script("patrol")
spin = script("spin")

# In the mission's language and in Promela's; Debian's SPIN is built without X.
CLAIMS = {
    "looks_again": ("[] <> pending READY a0", "[] <> (seen[0] != 0)"),
    "moves": ("pending CTR a0 leads to not pending CTR a0", "[] ((ctr[0] != NONE) -> <> (ctr[0] == NONE))"),
    "asks_again": ("infinitely often pending CTR a0", "[] <> (ctr[0] != NONE)"),
    "leaves": ("eventually not actually uav0 in cell0", "<> (uav_at[0] != 0)"),
    "stays": ("actually uav0 in cell0 W pending CTR a0", "(uav_at[0] == 0) W (ctr[0] != NONE)"),
    "looks_first": ("not pending CTR a0 U pending READY a0", "(ctr[0] == NONE) U (seen[0] != 0)"),
    "looks_or_rests": ("not pending CTR a0 W pending READY a0", "(ctr[0] == NONE) W (seen[0] != 0)"),
    "drifts": (
        "actually spill0 in cell1 leads to actually spill0 in cell2",
        "[] ((spill_at == 1) -> <> (spill_at == 2))",
    ),
    "comes_to_rest": ("eventually always actually spill0 in cell1", "<> [] (spill_at == 1)"),
    "believes": ("[] (uav0 in cell0 -> actually uav0 in cell0)", "[] ((uav_in[0] == 0) -> (uav_at[0] == 0))"),
    "released": ("pending READY a0 R not pending CTR a0", "(seen[0] != 0) V (ctr[0] == NONE)"),
    "recurs": (
        "([] <> actually spill0 in cell1) -> [] <> actually spill0 in cell2",
        "([] <> (spill_at == 1)) -> ([] <> (spill_at == 2))",
    ),
}
SIZE = (1, 2, True)
FAIR = "weak fairness of agents, environment"


def decided(size, fair):
    """Return the verdicts of the checker by the names of the claims."""
    under = f" under {FAIR}" if fair else ""
    lines = [f'  ltl "{name}"{under}: {claim}' for name, (claim, _) in CLAIMS.items()]
    text = f"{patrol.mission_text(*size)}\ncheck {{\n" + "\n".join(lines) + "\n}\n"
    source, tree = parse_bytes("patrol.mission", text.encode())
    mission = elaborate(tree, source, Path())
    report = check(mission.initial, mission.properties)
    return {each.property.name: each.outcome.value for each in report.verdicts if each.property.kind == "ltl"}


@pytest.mark.long
@pytest.mark.skipif(bool(spin.missing()), reason=f"not installed: {', '.join(spin.missing())}")
def test_spin_decides_the_same(tmp_path):
    theirs = spin.verdicts(patrol.promela_text(*SIZE), {name: c for name, (_, c) in CLAIMS.items()}, tmp_path)
    for fair, verdicts in theirs.items():
        assert decided(SIZE, fair) == {
            name: "holds" if holds else "violated" for name, holds in verdicts.items()
        }
    assert theirs[False] != theirs[True]
    assert {*theirs[False].values()} == {*theirs[True].values()} == {True, False}
