from bigactors import trace_files


def test_the_demo_ends_well_with_verdicts_pictures_and_traces(missions, done, monkeypatch):
    monkeypatch.setattr(trace_files, "draw_run", lambda *_, **__: None)  # half a minute of pictures
    out = done("demo", "--out", "shown")
    for mission in ("oil_spill", "harbour_watch"):
        assert f"\n{mission}: " in f"\n{out}"
        assert f"picture: shown/{mission}.svg" in out
        assert (missions / "shown" / f"{mission}.svg").stat().st_size > 1000
        assert list((missions / "shown" / mission).glob("*/trace.json"))
    assert "violated" not in out
    assert "INCOMPLETE" not in out
