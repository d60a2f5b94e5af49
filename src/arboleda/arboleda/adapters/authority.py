"""A certificate authority of a lab's own, with the library cryptography, which not every install has."""

from __future__ import annotations

import ipaddress
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from cryptography import x509
from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.asymmetric.types import CertificatePublicKeyTypes
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
    load_pem_private_key,
)
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from arboleda.model.errors import StartError

LASTS = timedelta(days=3650)  # life of an authority; long, as every board has to be given the next one
BEFORE = timedelta(hours=1)  # clocks of boards and machines may be late by so much
SIGNS = ("key_cert_sign", "crl_sign")
USES = (
    *("digital_signature", "content_commitment", "key_encipherment", "data_encipherment", "key_agreement"),
    *("key_cert_sign", "crl_sign", "encipher_only", "decipher_only"),
)


@dataclass(frozen=True, kw_only=True)
class Pair:
    """Certificate and its key, as PEM."""

    certificate: bytes
    key: bytes


@dataclass(frozen=True, kw_only=True)
class Facts:
    """End and names of one certificate."""

    until: datetime
    names: tuple[str, ...]  # names of a host, and its addresses


class Authority:
    """Certificate authority, which signs certificates; `pair` are its own two files.

    Raises StartError if the files cannot be used.
    """

    def __init__(self, pair: Pair) -> None:
        self.pair = pair
        self._certificate = _certificate(pair.certificate)
        try:
            key = load_pem_private_key(pair.key, None)
        except (ValueError, TypeError, UnsupportedAlgorithm) as error:
            raise StartError("its key is none that can be read") from error
        if not isinstance(key, ec.EllipticCurvePrivateKey) or _spki(key.public_key()) != _spki(
            self._certificate.public_key()
        ):
            raise StartError("certificate and key do not belong together")
        self._key = key

    @property
    def until(self) -> datetime:
        """The time at which this authority's certificate expires, and with it all that it signed."""
        return self._certificate.not_valid_after_utc

    def host(self, user: str, names: Sequence[str], now: datetime, days: int) -> Pair:
        """A certificate for a server with these names and addresses; it may also log in as `user`."""
        uses = [ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]
        return self._sign(user, uses, now, days, x509.SubjectAlternativeName([_name(each) for each in names]))

    def client(self, user: str, now: datetime, days: int) -> Pair:
        """A certificate for a client that logs in as `user`."""
        return self._sign(user, [ExtendedKeyUsageOID.CLIENT_AUTH], now, days)

    def signed(self, certificate: bytes) -> Facts | None:
        """The end and names of a certificate that this authority signed; None for any other certificate."""
        read = _certificate(certificate)
        try:
            read.verify_directly_issued_by(self._certificate)
        except (ValueError, TypeError, InvalidSignature):
            return None
        try:
            names = read.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
        except x509.ExtensionNotFound:
            return Facts(until=read.not_valid_after_utc, names=())
        found = (
            *names.get_values_for_type(x509.DNSName),
            *map(str, names.get_values_for_type(x509.IPAddress)),
        )
        return Facts(until=read.not_valid_after_utc, names=found)

    def _sign(
        self,
        user: str,
        uses: Sequence[x509.ObjectIdentifier],
        now: datetime,
        days: int,
        *more: x509.ExtensionType,
    ) -> Pair:
        key = ec.generate_private_key(ec.SECP256R1())
        until = min(now + timedelta(days=days), self.until)
        builder = (
            _builder(user, key, now, until)
            .issuer_name(self._certificate.subject)
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(_usage("digital_signature"), critical=True)
            .add_extension(x509.ExtendedKeyUsage(uses), critical=False)
            .add_extension(
                x509.AuthorityKeyIdentifier.from_issuer_public_key(self._key.public_key()), critical=False
            )
        )
        for each in more:
            builder = builder.add_extension(each, critical=False)
        return _pair(builder.sign(self._key, hashes.SHA256()), key)


def new(name: str, now: datetime) -> Authority:
    """A new authority called `name`, whose certificate may sign others and do nothing else."""
    key = ec.generate_private_key(ec.SECP256R1())
    builder = (
        _builder(name, key, now, now + LASTS)
        .issuer_name(_called(name))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(*SIGNS), critical=True)
    )
    return Authority(_pair(builder.sign(key, hashes.SHA256()), key))


def _builder(
    name: str, key: ec.EllipticCurvePrivateKey, now: datetime, until: datetime
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(_called(name))
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - BEFORE)
        .not_valid_after(until)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
    )


def _called(name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])


def _usage(*uses: str) -> x509.KeyUsage:
    return x509.KeyUsage(**{each: each in uses for each in USES})


def _name(text: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(text))
    except ValueError:
        return x509.DNSName(text)


def _pair(certificate: x509.Certificate, key: ec.EllipticCurvePrivateKey) -> Pair:
    return Pair(
        certificate=certificate.public_bytes(Encoding.PEM),
        key=key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption()),
    )


def _certificate(pem: bytes) -> x509.Certificate:
    try:
        return x509.load_pem_x509_certificate(pem)
    except ValueError as error:
        raise StartError("holds no certificate") from error


def _spki(key: CertificatePublicKeyTypes) -> bytes:
    return key.public_bytes(Encoding.DER, PublicFormat.SubjectPublicKeyInfo)
