from elaborating import elaborated

from semantics.live_policy import Fallback, LivePolicy, TimeLimit

WORLD = "signature { kind P } world { p0: P = point (1, 1) } BigActor a hosted_at p0 with_behavior { skip }"


def precautions_of(text):
    return elaborated(WORLD + text).precautions


def test_without_a_live_section_vehicles_hold_when_an_assumption_breaks():
    assert precautions_of("") == LivePolicy(Fallback.HOLD, ())


def test_precautions_are_read_in_the_order_written():
    text = "live { on broken assumption: return FLY a within 1.5 min: return; anyone within 1 h: continue }"
    assert precautions_of(text) == LivePolicy(
        Fallback.RETURN,
        (TimeLimit("FLY", "a", 90.0, Fallback.RETURN), TimeLimit(None, None, 3600.0, Fallback.CONTINUE)),
    )


def test_a_broken_property_has_a_response_of_its_own_and_vehicles_go_on_without_one():
    assert precautions_of("").on_broken_property is Fallback.CONTINUE
    both = precautions_of("live { on broken property: hold; on broken assumption: return }")
    assert both == LivePolicy(Fallback.RETURN, (), Fallback.HOLD)


def test_precautions_change_nothing_that_is_checked():
    limited = elaborated(WORLD + "live { a within 1 s: return }")
    assert elaborated(WORLD).initial == limited.initial


def test_a_limit_covers_the_requests_that_it_is_about():
    limit = TimeLimit("FLY", "a", 1.0, Fallback.HOLD)
    assert limit.covers("FLY", "a")
    assert not limit.covers("CTR", "a")
    assert not limit.covers("FLY", "b")
    assert TimeLimit(None, None, 1.0, Fallback.HOLD).covers("CTR", "b")
