"""Signed verdicts: a run that trusts a key flies by a verdict that is signed with it, and by no other."""

import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from bigactors.verdict_files import _seal

SCHEMA = Path(__file__).parents[2] / "docs" / "reference" / "verdict.schema.json"
CHECK = ("check", "--no-traces", "--control", "timed", "--verdict", "v.json", "oil_spill")
RUN = (
    "run",
    "oil_spill",
    "--verdict",
    "v.json",
    "--vehicle=uav0=udp:127.0.0.1:0",
    "--wait",
    "0.1",
    "--socket",
    "s",
)

MALFORMED = """\
v.json: the verdict's signature is malformed: \
it should be an object with 'key' and 'ed25519', which is 64 bytes in base64
  hint: the one who is trusted signs it: bigactors check --verdict FILE --sign KEY
"""


@pytest.fixture
def there(tmp_path, monkeypatch, bigactors):
    """Work where there is a key pair, and a verdict that is signed with it."""
    monkeypatch.chdir(tmp_path)
    assert bigactors("keygen", "own.key")[0] == 0
    assert bigactors(*CHECK, "--sign", "own.key")[0] == 0
    return tmp_path


def changed(path, **members):
    data = json.loads(path.read_text(encoding="utf-8")) | members
    path.write_text(json.dumps(data | {"seal": _seal(data)}), encoding="utf-8")


def test_a_key_is_for_its_owner_alone_and_never_written_over(there, bigactors):
    assert stat.S_IMODE((there / "own.key").stat().st_mode) == 0o600
    before = (there / "own.key").read_bytes()
    code, out, err = bigactors("keygen", "own.key")
    assert (code, out) == (2, "")
    assert err == "own.key: it is there already\n  hint: give another name, or move it away\n"
    assert (there / "own.key").read_bytes() == before
    (there / "own.key").unlink()
    assert bigactors("keygen", "own.key")[2].startswith("own.key.pub: it is there already")
    assert not (there / "own.key").exists()


def test_a_signed_verdict_is_as_its_schema_says(there):
    data = json.loads((there / "v.json").read_text(encoding="utf-8"))
    Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(data)
    assert sorted(data["signature"]) == ["ed25519", "key"]


@pytest.mark.usefixtures("there")
def test_who_trusts_the_key_flies_and_so_does_who_asks_for_no_signature(bigactors):
    for trust in (("--trust", "own.key.pub"), ()):
        code, _, err = bigactors(*RUN, *trust)
        assert (code, err) == (
            2,
            "bigactors: nothing was heard of uav0\n  hint: is the address right, and the vehicle switched on?\n",
        )


def test_a_verdict_that_was_changed_and_sealed_again_does_not_fly(there, bigactors):
    changed(there / "v.json", engine="reference")
    assert "nothing was heard of uav0" in bigactors(*RUN)[2]  # a seal alone doesn't show it
    code, _, err = bigactors(*RUN, "--trust", "own.key.pub")
    assert code == 2
    assert err.startswith(
        "v.json: the verdict was changed after it was signed\n  hint: the one who is trusted signs it"
    )


def test_a_verdict_without_a_signature_does_not_fly(there, bigactors):
    changed(there / "v.json", signature=None)
    assert "the verdict bears no signature" in bigactors(*RUN, "--trust", "own.key.pub")[2]


@pytest.mark.parametrize("signature", ["x", 7, {}, {"key": 1, "ed25519": "x"}])
def test_a_malformed_signature_does_not_fly(there, bigactors, signature):
    changed(there / "v.json", signature=signature)
    assert bigactors(*RUN, "--trust", "own.key.pub")[2] == MALFORMED


@pytest.mark.parametrize("value", ["", "!", "QUJD", "A" * 88, "ſ" * 86 + "=="])
def test_a_signature_that_is_no_base64_of_64_bytes_does_not_fly(there, bigactors, value):
    data = json.loads((there / "v.json").read_text(encoding="utf-8"))
    changed(there / "v.json", signature=data["signature"] | {"ed25519": value})
    assert bigactors(*RUN, "--trust", "own.key.pub")[2] == MALFORMED


def test_a_signature_of_something_else_does_not_fly(there, bigactors):
    data = json.loads((there / "v.json").read_text(encoding="utf-8"))
    changed(there / "v.json", signature=data["signature"] | {"ed25519": "A" * 86 + "=="})
    assert "the verdict was changed after it was signed" in bigactors(*RUN, "--trust", "own.key.pub")[2]


@pytest.mark.usefixtures("there")
def test_the_signature_of_another_key_does_not_fly(bigactors):
    bigactors("keygen", "other.key")
    code, _, err = bigactors(*RUN, "--trust", "other.key.pub")
    assert code == 2
    assert "the verdict is signed by another key: sha256:" in err


def test_what_is_no_key_is_told_before_anything_is_explored(there, bigactors):
    (there / "none").write_text("no key", encoding="utf-8")
    (there / "none").chmod(0o600)
    made = "openssl genpkey -algorithm RSA -out rsa.key && openssl pkey -in rsa.key -pubout -out rsa.key.pub"
    subprocess.run(["sh", "-c", f"umask 077; {made}"], check=True, cwd=there, capture_output=True)
    for path, said in (
        (
            "none",
            "none: this is no key to sign with: it is not in PEM, or is damaged\n  hint: give FILE of the pair",
        ),
        (
            "rsa.key",
            "rsa.key: this is no key to sign with: it is of another kind than Ed25519\n  hint: give FILE",
        ),
        (
            "own.key.pub",
            "own.key.pub: this is a public key, and the secret one signs\n  hint: give FILE of the pair",
        ),
        ("nowhere", "No such file"),
    ):
        code, out, err = bigactors(*CHECK, "--sign", path)
        assert (code, out) == (2, "")
        assert said in err
    (there / "own.key").chmod(0o640)
    assert (
        "its mode is 0640\n  hint: chmod 600 own.key; if others did, "
        in bigactors(*CHECK, "--sign", "own.key")[2]
    )
    for path, said in (
        (
            "none",
            "none: this is no public key: it is not in PEM, or is damaged\n  hint: give the FILE.pub of the one",
        ),
        (
            "rsa.key.pub",
            "rsa.key.pub: this is no public key: it is of another kind than Ed25519\n  hint: give the",
        ),
        (
            "own.key",
            "own.key: this is a secret key, and the public one is trusted\n  hint: give the FILE.pub of",
        ),
    ):
        assert said in bigactors(*RUN, "--trust", path)[2]


@pytest.mark.usefixtures("there")
def test_options_that_do_not_go_together_are_told(bigactors):
    assert "--sign signs a verdict" in bigactors("check", "--sign", "own.key", "oil_spill")[2]
    assert "--trust for a signed one" in bigactors(*RUN, "--unverified", "--trust", "own.key.pub")[2]


def test_a_key_of_openssl_serves_as_well(there, bigactors):
    made = "openssl genpkey -algorithm ed25519 -out o.key && openssl pkey -in o.key -pubout -out o.key.pub"
    subprocess.run(["sh", "-c", f"umask 077; {made}"], check=True, cwd=there, capture_output=True)
    assert bigactors(*CHECK, "--sign", "o.key")[0] == 0
    assert "nothing was heard of uav0" in bigactors(*RUN, "--trust", "o.key.pub")[2]
    locked = "openssl genpkey -algorithm ed25519 -aes256 -pass pass:x -out locked.key"
    subprocess.run(["sh", "-c", f"umask 077; {locked}"], check=True, cwd=there, capture_output=True)
    assert "it needs a passphrase" in bigactors(*CHECK, "--sign", "locked.key")[2]


def test_without_the_extra_it_is_said_how_to_have_it(tmp_path):
    line = "import sys; sys.modules['cryptography'] = None; from bigactors.cli import main; exit(main(sys.argv[1:]))"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    ran = subprocess.run(
        [sys.executable, "-c", line, "keygen", "k"],
        check=False,
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert (ran.returncode, "pip install '.[live]'" in ran.stderr) == (2, True)
