"""What stations say to each other, on links that lose, double, reorder and part: all come to know all of it."""

import json
import re
import tempfile
from contextlib import contextmanager
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from json_mutations import mutated
from live_missions import EAST, WEST
from msgspec.json import encode
from scale import examples
from test_station_plugin import ENTRIES, MISSION, Node, World

from adapters.plugin import Delivered
from adapters.stations.entries import Entry, Posted, Said, entry_of, entry_text
from adapters.stations.peers import peers_of
from adapters.stations.station_messages import StationMessage, fitting, read
from physical import PhysicalError

NAMES = ("gcs0", "gcs1", "gcs2")
TABLE = {name: {"connect": [f"tcp/127.0.0.1:{port}"]} for port, name in enumerate(NAMES, 1)}


class Reader(World):
    """A run that looks, whenever a parcel comes, whether all is known that its sender knew."""

    def report(self, report):
        super().report(report)
        if isinstance(report, Delivered):
            for station, entity, number in report.parcel:
                known = self.words.get(entity, {}).get(station)
                assert station == self.station or (known is not None and known.number >= number)


class Wire:
    """Takes what is put, in the place of the bus."""

    def __init__(self):
        self.put_there = []

    def put(self, said):
        self.put_there.append(said)


class Company:
    """Three stations; the test carries what they say."""

    def __init__(self, folder):
        self.nodes = {name: Node(peers_of(TABLE, name, folder), folder) for name in NAMES}
        for node in self.nodes.values():
            node.world.__class__ = Reader
            node.world.words, node.world.station = node.sharing.merge.words, node.journal.station
            node.sharing._world = node.world
        self.under_way = []

    def put(self, name, fates):
        """Let a station put what it has to say: for each other it is lost, heard at once, late, or twice."""
        wire = Wire()
        self.nodes[name].sharing._put(wire)
        for said in wire.put_there:
            for other, fate in zip((other for other in NAMES if other != name), fates, strict=True):
                self.under_way += [(name, other, said)] * (fate in ("late", "twice"))
                if fate in ("at once", "twice"):
                    self.nodes[other].sharing._hear(name, said)

    def carry(self, index):
        name, other, said = self.under_way.pop(index)
        self.nodes[other].sharing._hear(name, said)

    def ask(self, name, of):
        """Ask once, as is done each second."""
        mine, theirs = self.nodes[name].sharing, self.nodes[of].sharing
        other = mine.others[of]
        answer = theirs._answer("", b'{"after": %d}' % other.heard)
        more = mine._told(self.nodes[name].world, of, mine._read(of, answer), self.nodes[name].world.now())
        mine._deliver()
        return more

    def meet(self):
        """Let each ask each, until there is nothing more to ask for."""
        for name in NAMES:
            for other in NAMES:
                while name != other and self.ask(name, other):
                    pass


@contextmanager
def company_of_three():
    with tempfile.TemporaryDirectory() as folder:
        company = Company(Path(folder))
        try:
            yield company
        finally:
            for node in company.nodes.values():
                node.journal.close()


FATES = st.sampled_from(["lost", "at once", "late", "twice"])


def happens(data, company):
    what = data.draw(st.sampled_from(["see", "post", "put", "put", "carry", "ask"]))
    name, other = data.draw(st.permutations(NAMES))[:2]
    node = company.nodes[name]
    if what == "see":
        node.see(data.draw(st.sampled_from(["boat0", "boat1"])), data.draw(st.sampled_from([WEST, EAST])))
    elif what == "post":
        words = node.sharing.merge.words.values()
        rests_on = [
            (entry.station, entry.content.entity, entry.number) for each in words for entry in each.values()
        ]
        knows = {
            each: known.last for each, known in node.sharing.others.items() if each != other and known.last
        }
        number = node.journal.sent(other) + 1
        node.sharing._add([Posted(other, number, rests_on, knows)])
    elif what == "put":
        company.put(name, data.draw(st.tuples(FATES, FATES)))
    elif what == "ask":
        company.ask(name, other)
    elif company.under_way:
        company.carry(data.draw(st.integers(0, len(company.under_way) - 1)))


@examples(40)
@given(st.data())
def test_whatever_was_lost_doubled_or_reordered_all_come_to_one_world(data):
    with company_of_three() as company:
        if data.draw(st.booleans()):
            company.meet()
        for _ in range(data.draw(st.integers(0, 40))):
            happens(data, company)
        company.meet()
        worlds = [
            {entity: node.world.at(entity) for entity in ("boat0", "boat1")}
            for node in company.nodes.values()
        ]
        for node in company.nodes.values():
            for other in NAMES:
                if other != node.journal.station:
                    sent = company.nodes[other].journal.sent(node.journal.station)
                    told = [each.number for each in node.world.of(Delivered) if each.station == other]
                    assert told == list(range(1, sent + 1))  # in order, and once as long as nobody asks again
        assert worlds[0] == worlds[1] == worlds[2]


def test_a_parcel_enters_after_what_its_sender_had_said_before():
    with company_of_three() as company:
        gcs0, gcs1 = company.nodes["gcs0"], company.nodes["gcs1"]
        company.meet()
        gcs0.see("boat0", WEST)
        company.put("gcs0", ("lost", "lost"))
        gcs0.sharing._add([Posted("gcs1", 1, [])])
        company.put("gcs0", ("at once", "lost"))
        assert (gcs1.world.of(Delivered), gcs1.world.at("boat0")) == ([], None)
        company.ask("gcs1", "gcs0")
        assert ([each.number for each in gcs1.world.of(Delivered)], gcs1.world.at("boat0")) == ([1], WEST)


@pytest.mark.parametrize("reached", [True, False])
def test_a_parcel_enters_after_what_its_sender_had_heard_of_others_that_can_be_reached(reached):
    with company_of_three() as company:
        gcs0, gcs1, gcs2 = company.nodes.values()
        company.meet()
        gcs0.see("boat0", WEST)
        company.put("gcs0", ("at once", "lost"))
        gcs2.sharing.others["gcs0"].reached = reached
        known = gcs1.sharing.others["gcs0"].last
        gcs1.sharing._add([Posted("gcs2", 1, [], {"gcs0": known})])
        company.put("gcs1", ("lost", "at once"))
        assert len(gcs2.world.of(Delivered)) == (0 if reached else 1)
        company.ask("gcs2", "gcs0")
        assert len(gcs2.world.of(Delivered)) == 1
        assert gcs2.world.at("boat0") == WEST


def test_a_message_tells_up_to_where_it_is_whole():
    entries = [Entry("gcs0", number, Posted("gcs1", number, "x" * 200_000)) for number in range(1, 9)]
    texts, upto = fitting(entries, 20)
    assert (len(texts), upto) == (5, 5)
    assert fitting(entries[:2], 20)[1] == 20
    assert len(fitting(entries[:1] * 2_000, 7)[0]) <= 500
    message = read(encode(StationMessage(MISSION, 1.5, 3, upto, 20, texts)))
    assert (message.mission, message.time, message.after, message.upto, message.last) == (
        MISSION,
        1.5,
        3,
        5,
        20,
    )
    assert len(message.entries) == 5


@given(st.binary(max_size=200))
def test_what_is_no_message_is_refused(data):
    company = read_or_none(data)
    assert company is None or isinstance(company, StationMessage)


def read_or_none(data):
    try:
        return read(data)
    except ValueError:
        return None


@examples(100)
@given(st.data())
def test_no_change_of_a_message_breaks_more_than_itself(data):
    with company_of_three() as company:
        company.nodes["gcs0"].see("boat0", WEST)
        company.nodes["gcs0"].sharing._add([Posted("gcs1", 1, [])])
        said = company.nodes["gcs0"].sharing._answer("", b'{"after": 0}').decode()
        for _ in range(data.draw(st.integers(1, 3))):
            at = data.draw(st.integers(0, 999)) % len(said)
            said = (
                said[:at]
                + data.draw(st.sampled_from(['"', "0", "9", "[", "]", "null", "-", ",", "e"]))
                + said[at + 1 :]
            )
        company.nodes["gcs1"].sharing._hear("gcs0", said.encode())
        words = company.nodes["gcs1"].sharing.merge.words
        assert all(isinstance(entry.content, Said) for each in words.values() for entry in each.values())


@examples(400)
@given(mutated([{"mission": MISSION, "time": 1.0, "after": 0, "upto": 9, "last": 9, "entries": ENTRIES}]))
def test_a_message_with_a_fault_is_read_or_refused_and_so_is_each_of_its_entries(said):
    message = read_or_none(said)
    for data in () if message is None else message.entries:
        try:
            entry = entry_of("gcs0", data)
        except ValueError:
            continue
        assert entry_of("gcs0", json.loads(entry_text(entry))) == entry


@pytest.mark.parametrize("data", ENTRIES)
def test_an_entry_without_one_of_its_members_names_it_or_is_another_entry(data):
    for member in data:
        rest = {name: value for name, value in data.items() if name != member}
        try:
            assert entry_of("gcs0", rest).number == data["n"]
        except ValueError as error:
            assert re.match(r"`\$`: it lacks `\w+`|an entry is of no known kind", str(error))  # noqa: PT017


def test_what_is_wrong_with_a_message_names_its_place():
    good = {"mission": MISSION, "time": 1.0, "after": 0, "upto": 9, "last": 9, "entries": []}
    for member, value, fault in [
        ("upto", True, "`$.upto`: expected `int`, got `bool`"),
        ("time", 1e300, "`$.time`: expected `float` <= 1000000000000000.0"),
        ("entries", [1] * 1_001, "`$.entries`: expected `array` of length <= 1000"),
    ]:
        with pytest.raises(PhysicalError, match=re.escape(fault)):
            read(json.dumps({**good, member: value}).encode())
    with pytest.raises(PhysicalError, match="the key 'upto' is there twice"):
        read(json.dumps(good).replace('"upto"', '"upto": 1, "upto"').encode())
