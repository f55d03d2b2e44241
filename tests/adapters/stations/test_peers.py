import sys

import pytest

from adapters.stations.bus import _library, settings
from adapters.stations.peers import MOST_BYTES, peers_of, read_peers
from physical import PhysicalError

GOOD = """
[gcs0]
connect = ["tcp/127.0.0.1:7447"]
hosts = ["uav0"]
[gcs1]
listen = ["tcp/0.0.0.0:7448"]
connect = ["tcp/gcs1.example.net:7448"]
"""


def read(tmp_path, text, station="gcs0"):
    path = tmp_path / "peers.toml"
    path.write_text(text)
    return read_peers(path, station)


def test_a_station_knows_where_it_listens_who_the_others_are_and_what_runs_where(tmp_path):
    peers = read(tmp_path, GOOD)
    assert peers.own.listen == ("tcp/127.0.0.1:7447",)
    assert list(peers.others) == ["gcs1"]
    assert peers.hosts == {"gcs0": "gcs0", "uav0": "gcs0", "gcs1": "gcs1"}
    assert read(tmp_path, GOOD, "gcs1").own.listen == ("tcp/0.0.0.0:7448",)


def test_nothing_is_scouted_and_nobody_else_is_asked(tmp_path):
    found = settings(read(tmp_path, GOOD), "tour")
    assert found["connect"]["endpoints"] == ["tcp/gcs1.example.net:7448"]
    assert found["scouting"] == {"multicast": {"enabled": False}, "gossip": {"enabled": False}}
    assert "access_control" not in found


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("gcs0 = 3", "gcs0 is no table"),
        ("[gcs1]\nconnect = ['tcp/127.0.0.1:1']", "no station 'gcs0': its stations are gcs1"),
        ("[gcs0]\n", "has no address to connect to"),
        ("[gcs0]\nconnect = 'tcp/127.0.0.1:1'", "no list"),
        ("[gcs0]\nconnect = ['udp/127.0.0.1:1']", "no endpoint"),
        ("[gcs0]\nconnect = ['tcp/127.0.0.1:70000']", "no endpoint"),
        ("[gcs0]\nconnect = ['tcp/127.0.0.1:1#iface=lo']", "no endpoint"),
        ("[gcs0]\nconnect = ['tls/127.0.0.1:1']", "the file has no [tls]"),
        ("[gcs0]\nconnect = ['tcp/example.net:1']", "has no address to listen at"),
        ("[gcs0]\nconect = []", "has 'conect'"),
        ("['gcs 0']\nconnect = []", "no name of a station"),
        (
            GOOD.replace("7448", "7447").replace("gcs1.example.net", "127.0.0.1"),
            "belongs to gcs0 and to gcs1",
        ),
        (GOOD + "hosts = ['uav0']", "uav0 belongs to gcs0 and to gcs1"),
        (GOOD + "[tls]\nca = 'x'", "ca, certificate and key"),
        ("[tls]\nca = 'no'\ncertificate = 'such'\nkey = 'file'", "there is no file"),
        ("[gcs0", "no TOML"),
        ("gcs0 = " + 5_000 * "1", "no TOML"),
        ("\n".join(f"[s{n}]" for n in range(40)), "more than 32 stations"),
        ("#" * (MOST_BYTES + 1), "more than 65,536 bytes"),
    ],
)
def test_what_is_no_peers_file_says_why_and_what_to_do(tmp_path, text, says):
    with pytest.raises(PhysicalError) as caught:
        read(tmp_path, text)
    assert says in caught.value.message
    assert caught.value.hint


def test_without_zenoh_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "zenoh", None)
    with pytest.raises(PhysicalError) as caught:
        _library()
    assert caught.value.message == "stations need Zenoh, which is not installed"
    assert "'.[stations]'" in caught.value.hint


def test_a_certificate_may_say_and_ask_only_what_its_name_allows(tmp_path):
    for name in ("ca.pem", "gcs0.pem", "gcs0.key"):
        (tmp_path / name).touch()
    tls = {"ca": "ca.pem", "certificate": "{station}.pem", "key": "{station}.key"}
    table = {name: {"connect": [f"tls/127.0.0.1:{port}"]} for name, port in (("gcs0", 1), ("gcs1", 2))}
    found = settings(peers_of({**table, "tls": tls}, "gcs0", tmp_path), "tour")
    assert found["transport"]["link"]["tls"]["enable_mtls"] is True
    access = found["access_control"]
    assert access["default_permission"] == "deny"
    (says,) = (rule for rule in access["rules"] if rule["id"] == "says gcs1")
    assert says["key_exprs"] == ["bigactors/tour/gcs1/*"]
    assert access["subjects"] == [{"id": "gcs1", "cert_common_names": ["gcs1"]}]
