"""Signatures of verdicts (Ed25519), which show the author and detect changes; key pairs as PEM files.

The only place that knows the library `cryptography`.
"""

from __future__ import annotations

import base64
import hashlib
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Final

from adapters.private import open_private, others_may_read
from bigactors.files import read_bytes
from bigactors.mistakes import Mistake, unreadable

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric import ed25519

    SigningKey = ed25519.Ed25519PrivateKey
    TrustedKey = ed25519.Ed25519PublicKey

DOMAIN: Final = b"bigactors.verdict/1\0"
"""What stands before each text that is signed, so that no signature of anything else is one of a verdict."""

MOST_BYTES: Final = 10_000
"""The most bytes of a key that are read."""

PUBLIC: Final = ".pub"


def new_pair(path: Path) -> Path:
    """Write a new key and beside it, as `.pub`, what others trust; return that. Raises Mistake where one is there."""
    public = path.with_name(path.name + PUBLIC)
    key = _crypto().ed25519.Ed25519PrivateKey.generate()
    for target in (path, public):
        if target.exists():
            raise Mistake("it is there already", "give another name, or move it away", str(target))
    try:
        with open_private(path, "xb") as file:
            file.write(_private_pem(key))
        public.write_bytes(_public_pem(key.public_key()))
    except OSError as error:
        raise unreadable(str(path), error) from error
    return public


def load_key(path: str) -> SigningKey:
    """Return the key to sign with; raises Mistake for one that is none, or that others may read."""
    crypto, data = _crypto(), read_bytes(path, MOST_BYTES)
    if mode := others_may_read(Path(path)):
        hint = f"chmod 600 {path}; if others did, make another: bigactors keygen FILE"
        raise Mistake(f"others may read the key: its mode is {mode}", hint, path)
    try:
        key = crypto.serialization.load_pem_private_key(data, password=None)
    except (ValueError, TypeError, crypto.exceptions.UnsupportedAlgorithm) as error:
        raise _no_key(path, "a key to sign with", error) from error
    if not isinstance(key, crypto.ed25519.Ed25519PrivateKey):
        raise _no_key(path, "a key to sign with")
    found: SigningKey = key
    return found


def load_trusted(path: str) -> TrustedKey:
    """Return the public key that is trusted; raises Mistake for one that is none."""
    crypto, data = _crypto(), read_bytes(path, MOST_BYTES)
    try:
        key = crypto.serialization.load_pem_public_key(data)
    except (ValueError, TypeError, crypto.exceptions.UnsupportedAlgorithm) as error:
        raise _no_key(path, f"a public key, FILE{PUBLIC}", error) from error
    if not isinstance(key, crypto.ed25519.Ed25519PublicKey):
        raise _no_key(path, f"a public key, FILE{PUBLIC}")
    found: TrustedKey = key
    return found


def signature_json(key: SigningKey, text: bytes) -> dict[str, str]:
    """Return the signature of a text as plain data: whose it is, and what it is."""
    value = base64.b64encode(key.sign(DOMAIN + text)).decode("ascii")
    return {"key": fingerprint(key.public_key()), "ed25519": value}


def check_signature(signature: Any, text: bytes, trusted: TrustedKey, path: str) -> None:
    """Refuse a verdict whose signature is not the trusted key's; raises Mistake with what is wrong."""
    hint = "the one who is trusted signs it: bigactors check --verdict FILE --sign KEY"
    match signature:
        case {"key": str(whose), "ed25519": str(value)}:
            pass
        case _:
            raise Mistake("the verdict has no signature", hint, path)
    if whose != fingerprint(trusted):
        said = f"the verdict is signed by another key: {whose:.80}, and {fingerprint(trusted)} is trusted"
        raise Mistake(said, hint, path)
    try:
        trusted.verify(base64.b64decode(value, validate=True), DOMAIN + text)
    except (ValueError, _crypto().exceptions.InvalidSignature) as error:
        raise Mistake("the verdict was changed after it was signed", hint, path) from error


def fingerprint(key: TrustedKey) -> str:
    """Return a digest by which a key can be told from others."""
    return "sha256:" + hashlib.sha256(key.public_bytes_raw()).hexdigest()


def _private_pem(key: SigningKey) -> bytes:
    form = _crypto().serialization
    return key.private_bytes(form.Encoding.PEM, form.PrivateFormat.PKCS8, form.NoEncryption())


def _public_pem(key: TrustedKey) -> bytes:
    form = _crypto().serialization
    return key.public_bytes(form.Encoding.PEM, form.PublicFormat.SubjectPublicKeyInfo)


def _no_key(path: str, wanted: str, error: Exception | None = None) -> Mistake:
    reason = "it needs a passphrase" if isinstance(error, TypeError) else "it is no Ed25519 key in PEM"
    return Mistake(f"this is not {wanted}: {reason}", "make a pair: bigactors keygen FILE", path)


def _crypto() -> Any:
    """Return what is used of the library, which is an extra and slow to load."""
    try:
        from cryptography import exceptions  # noqa: PLC0415
        from cryptography.hazmat.primitives import serialization  # noqa: PLC0415
        from cryptography.hazmat.primitives.asymmetric import ed25519  # noqa: PLC0415
    except ImportError as error:
        raise Mistake("signatures need cryptography", "pip install 'bigactors[live]'") from error
    return SimpleNamespace(exceptions=exceptions, serialization=serialization, ed25519=ed25519)
