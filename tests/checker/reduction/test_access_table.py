"""The table of reads and writes: each read has a purpose, and each purpose a read."""

from shipped import LOADED

from checker.reduction import access_table


def test_exactly_the_reads_of_shipped_missions_have_a_purpose():
    reads, writes = access_table.accesses(mission.initial for mission in LOADED.values())
    assert {rule: set(found) for rule, found in reads.items()} == {
        rule: set(purposes) for rule, purposes in access_table.PURPOSES.items()
    }
    assert writes.keys() >= reads.keys()


def test_a_rule_that_applies_nowhere_has_no_row():
    lines = list(access_table.access_table([LOADED["crossing"].initial]))
    rules = {line.split("`")[1] for line in lines[2:]}
    assert {"command", "commit"} < rules
    assert rules.isdisjoint({"spawn", "migrate", "env", "say"})
