import pytest
from hypothesis import given
from hypothesis import strategies as st

from physical.written_times import LATEST, epoch_seconds, moment_text, time_beside


@pytest.mark.parametrize(
    "text",
    [
        "1772596630",
        "1772596630000",
        "1772596630000000",
        "1772596630000000000",
        "1772596630.0",
        "20260304035710",
        "20260304035710.000",
        "20260304T035710Z",
        "20260304T035710.000Z",
        "ts=1772596630;",
        "1772596630000,",
        "2026-03-04T03:57:10Z",
        "2026-03-04T03:57:10.000Z",
        "2026-03-04 03:57:10",
        "2026/03/04 03:57:10,000",
        "2026-03-04T04:57:10+01:00",
        "2026-03-04T04:57:10+0100",
        "2026-03-04 03:57:10 UTC",
        "[2026-03-04 03:57:10]:",
        "rxtime: 20260304035710)",
        '"rxuxtime":1772596630,',
        ",d-106,r003669945,1772596630",
    ],
)
def test_a_time_is_read_however_a_logger_writes_it(text):
    assert time_beside(text) == 1772596630.0


@pytest.mark.parametrize(
    "text",
    [
        "",
        "MMSI: 211000001",
        "03:57:10",
        "2026-13-04T03:57:10Z",
        "2026-03-04",
        "20261304035710",
        "-65.2",
        "r1772596630",
    ],
)
def test_what_is_no_time_with_a_date_is_none(text):
    assert time_beside(text) is None


def test_of_several_times_the_first_or_the_last_counts():
    assert time_beside("1772596630 1772596640") == 1772596630.0
    assert time_beside("1772596630 1772596640", last=True) == 1772596640.0


@pytest.mark.parametrize("text", ["", "x", "-1", "1e9", "9" * 20, "9" * 400, "4294967296", "٣" * 10])
def test_a_number_that_is_no_time_is_refused(text):
    with pytest.raises(ValueError, match="time"):
        epoch_seconds(text)


@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 1000, 10**6, 10**9]))
def test_a_time_is_the_same_in_all_its_units(seconds, unit):
    if seconds >= 1e9:
        assert epoch_seconds(str(seconds * unit)) == pytest.approx(seconds)


@given(st.text(max_size=60) | st.from_regex(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d:\d\d", fullmatch=True))
def test_no_text_raises_and_times_are_bounded(text):
    time = time_beside(text)
    assert time is None or 0 <= time < LATEST
    if time is not None:
        assert moment_text(time).endswith("Z")
