"""Login of this process at an OPC UA server: from the environment, never from a plant file."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from arboleda.drivers import DriverError
from arboleda_drivers.opcua.settings import Settings

FILES = ("CERT", "KEY", "SERVER_CERT")


@dataclass(frozen=True, kw_only=True)
class Login:
    """User name and certificate files; `server` is the only server certificate that is trusted."""

    user: str | None = None
    password: str = field(default="", repr=False)
    certificate: str = ""
    key: str = ""
    server: str = ""
    application: str = ""


def login(settings: Settings) -> Login:
    """The login for this server from the environment; raises DriverError, which names the missing one."""
    user = os.environ.get(f"{settings.secrets}_USER") or None
    password = os.environ.get(f"{settings.secrets}_PASSWORD", "")
    if settings.security == "none":
        if user is not None:
            what = f"{settings.secrets}_USER is set, and security: none would send its password readable"
            raise DriverError(f"{what}; write security: sign_and_encrypt")
        return Login()
    certificate, key, server = (_file(settings, name) for name in FILES)
    return Login(
        user=user,
        password=password,
        certificate=certificate,
        key=key,
        server=server,
        application=_application(certificate),
    )


def _file(settings: Settings, name: str) -> str:
    variable = f"{settings.secrets}_{name}"
    file = os.environ.get(variable, "")
    if not Path(file).is_file():
        what = f"{file} is no file" if file else "it is not set"
        raise DriverError(f"security: {settings.security} needs a file in {variable}; {what}")
    return file


def _application(certificate: str) -> str:
    """The application URI of a certificate: servers compare it with the one that the client gives."""
    from cryptography import x509

    data = Path(certificate).read_bytes()
    try:
        pem = data.startswith(b"-----")
        read = x509.load_pem_x509_certificate(data) if pem else x509.load_der_x509_certificate(data)
        names = read.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
        return names.get_values_for_type(x509.UniformResourceIdentifier)[0]
    except (ValueError, x509.ExtensionNotFound, IndexError) as error:
        what = "is no certificate with the URI of an application (subjectAltName = URI:urn:...)"
        raise DriverError(f"{certificate} {what}") from error
