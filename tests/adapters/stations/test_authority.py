"""Whom a vehicle obeys, told by links of which none knows when it was so."""

import pytest

from adapters.plugin import HandOver
from adapters.stations.authority import LASTING, Authority
from adapters.stations.entries import Said
from physical import PhysicalProperty, point

GCS0, GCS1, GCS2 = (("control:gcs0",), ("control:gcs1",), ("control:gcs2",))


def shown(channels):
    return PhysicalProperty("uav0", "UAV", point(37, -8), channels=channels, time=1.0)


def known(channels, since=5.0):
    return Said(shown(channels), since, owned=True)


def believed(authority, channels, of, now=10.0):
    return authority.channels("uav0", shown(channels), of, now)


def test_the_first_who_tells_is_believed():
    assert believed(Authority("gcs2"), GCS0, None) == (GCS0, 10.0)


def test_a_hand_over_that_was_commanded_counts_at_once_and_after_all_that_was_known():
    authority = Authority("gcs0")
    authority.hand_overs["uav0"] = HandOver("op0-1", "uav0", *GCS0, *GCS1)
    assert believed(authority, GCS0, known(GCS0)) == (GCS0, 5.0)
    channels, since = believed(authority, GCS1, known(GCS0, since=99.0))  # another's clock is ahead
    assert (channels, since > 99.0) == (GCS1, True)
    assert authority.hand_overs == {}


def test_a_link_that_lags_behind_is_not_believed():
    """It tells gcs1 when gcs2 has already handed on to gcs0: the network was faster."""
    authority = Authority("gcs0")
    for late in (GCS1, GCS2):
        assert believed(authority, late, known(GCS0)) == (GCS0, 5.0)
    assert believed(authority, GCS0, known(GCS0)) == (GCS0, 5.0)
    assert authority.doubts == {}


def test_what_lasts_is_believed():
    authority = Authority("gcs0")
    assert believed(authority, GCS2, known(GCS0), 10.0) == (GCS0, 5.0)
    assert believed(authority, GCS2, known(GCS0), 10.0 + LASTING - 0.1) == (GCS0, 5.0)
    assert believed(authority, GCS2, known(GCS0), 10.0 + LASTING) == (GCS2, 10.0 + LASTING)


def test_what_a_link_has_shown_all_along_is_no_news_when_others_have_handed_on():
    """A vehicle may answer only whom it obeys: another's link shows for ever what it has read last."""
    authority = Authority("gcs2")
    assert believed(authority, GCS0, known(GCS0)) == (GCS0, 5.0)
    for now in (20.0, 20.0 + 2 * LASTING):
        assert believed(authority, GCS0, known(GCS1, 19.0), now) == (GCS1, 19.0)


def test_what_was_commanded_since_is_newer_than_a_doubt():
    authority = Authority("gcs2")
    assert believed(authority, GCS0, known(GCS1, 9.0), 10.0) == (GCS1, 9.0)
    assert believed(authority, GCS0, known(GCS1, 11.0), 10.0 + LASTING) == (GCS1, 11.0)


def test_a_vehicle_is_kept_while_our_link_shows_that_it_obeys_us_and_we_have_not_handed_it_over():
    authority = Authority("gcs0")
    assert not authority.keeps("uav0")
    believed(authority, GCS0, None)
    assert authority.keeps("uav0")
    authority.hand_overs["uav0"] = HandOver("op0-1", "uav0", *GCS0, *GCS1)
    assert not authority.keeps("uav0")
    believed(authority, GCS1, known(GCS0))
    assert not authority.keeps("uav0")


@pytest.mark.parametrize(("of", "counts"), [(GCS0, True), (GCS1, False)])
def test_a_link_that_is_lost_says_so_only_of_its_own_authority(of, counts):
    authority = Authority("gcs0")
    assert believed(authority, GCS0, known(GCS0)) == (GCS0, 5.0)
    assert believed(authority, (), known(of)) == (((), 10.0) if counts else (of, 5.0))


def test_a_link_that_was_never_told_has_lost_nothing_when_its_vehicle_is_handed_to_us():
    """The vehicle answers nobody but whom it obeys: so our link is to hear of it only now."""
    authority = Authority("gcs1")
    assert believed(authority, (), known(GCS0)) == (GCS0, 5.0)
    for now in (100.0, 100.0 + LASTING - 0.1):
        assert believed(authority, (), known(GCS1, 99.0), now) == (GCS1, 99.0)
    assert believed(authority, GCS1, known(GCS1, 99.0), 100.0 + LASTING) == (GCS1, 99.0)
    assert authority.doubts == {}


def test_a_link_that_is_never_told_is_believed_in_the_end():
    authority = Authority("gcs1")
    assert believed(authority, (), known(GCS1, 99.0), 100.0) == (GCS1, 99.0)
    assert believed(authority, (), known(GCS1, 99.0), 100.0 + LASTING) == ((), 100.0 + LASTING)


def test_a_link_that_was_never_told_is_given_its_time_from_each_hand_over():
    authority = Authority("gcs1")
    believed(authority, (), known(GCS1, 9.0), 10.0)
    believed(authority, (), known(GCS0, 15.0), 15.0)
    assert believed(authority, (), known(GCS1, 20.0), 10.0 + LASTING) == (GCS1, 20.0)
    assert believed(authority, (), known(GCS1, 20.0), 10.0 + 2 * LASTING) == ((), 10.0 + 2 * LASTING)
