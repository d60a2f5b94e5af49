"""Forms for the drivers that a plant can name: a field for each setting, and the value of a filled form."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, fields
from enum import Enum
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from arboleda.drivers.port import GROUP, DriverSpec, spec_of
from arboleda.host.packages import entry_points
from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain, quoted

from . import package_drivers
from .drivers import OF_DEVICES
from .python_uses import LONGEST, error_text
from .yaml_flow import flow
from .yaml_marks import YamlFault, plain_value

Row = dict[str, Any]
FORMS = {bool: "bool", int: "int", float: "number", str: "text"}
FITS: Mapping[str, tuple[type, ...]] = {"int": (int,), "number": (int, float), "bool": (bool,)}
WHAT = {"int": "a whole number", "number": "a number", "bool": "true or false"}


@dataclass(frozen=True, kw_only=True)
class SettingsKey:
    """Key of a driver's settings. Its `form` is text, int, number, bool, choice or yaml.

    `default` is a text as a person writes it in a plant file; empty where there is none.
    """

    name: str
    form: str
    choices: tuple[str, ...] = ()
    required: bool = False
    can_be_null: bool = False
    default: str = ""
    about: str = ""

    def read(self, text: str) -> Any:
        """The value of a text that a person wrote; ArboledaError if the text is no value of this key."""
        if self.form == "text":
            return text
        if self.form == "choice":
            if text not in self.choices:
                raise ArboledaError(f"{self.name} must be one of {', '.join(self.choices)}")
            return text
        value = _yaml(self.name, text)
        if not self._fits(value):
            raise ArboledaError(f"{self.name} must be {WHAT[self.form]}, is {quoted(text)}")
        return value

    def _fits(self, value: Any) -> bool:
        fits = FITS.get(self.form)
        if fits is None or (value is None and self.can_be_null):
            return True
        return isinstance(value, fits) and isinstance(value, bool) == (bool in fits)


def forms(own: Mapping[str, DriverSpec], words: Mapping[str, str]) -> list[Row]:
    """A row for each driver that a device of a declared kind can have: `name`, `about`, `keys`, `why_not`.

    `why_not` says why the driver cannot be used. `own` are the drivers of the plant's own files. `words` are
    the descriptions of drivers and of their keys.
    """
    rows: list[Row] = [{"name": name, "about": words[name], "keys": [], "why_not": ""} for name in OF_DEVICES]
    made = {row["name"]: row for row in (_form(name, own, words) for name in _nameable(own))}
    for row in rows:  # with keys it is a mapping of the package of drivers, where that is installed
        found = made.pop(row["name"], row)
        row |= {} if found["why_not"] else found
    return [*rows, *made.values()]


def written(name: str, texts: Mapping[str, str], own: Mapping[str, DriverSpec]) -> Any:
    """The value of the key `driver` as a person writes it: without settings that equal their default.

    `texts` are the contents of the fields of the form; ArboledaError where one does not fit.
    """
    is_plain = name in OF_DEVICES and not any(text.strip() for text in texts.values())
    by_name = {} if is_plain else {each.name: each for each in keys(_spec(name, own))}
    if strange := sorted(texts.keys() - by_name.keys()):
        raise ArboledaError(f"the driver {name} has no key {quoted(strange[0])}")
    filled = {key: text.strip() for key, text in texts.items() if text.strip()}
    if missing := [each.name for each in by_name.values() if each.required and each.name not in filled]:
        raise ArboledaError(f"the driver {name} needs {', '.join(missing)}")
    values = {
        key.name: key.read(filled[key.name])
        for key in by_name.values()
        if key.name in filled and filled[key.name] != key.default
    }
    return {name: values} if values else name


def keys(spec: DriverSpec, words: Mapping[str, str] | None = None) -> Iterator[SettingsKey]:
    """The keys of the settings of a driver, without those that its dataclass hides."""
    if spec.settings is None:
        return
    hints = get_type_hints(spec.settings)
    for field in fields(spec.settings):
        if field.metadata.get("hidden"):
            continue
        about = (words or {}).get(f"{spec.name}.{field.name}") or field.metadata.get("about", "")
        yield _key(field, hints[field.name], plain(str(about), LONGEST))


def _nameable(own: Mapping[str, DriverSpec]) -> list[str]:
    installed = {point.name for point in entry_points(group=GROUP)} | package_drivers.OF_DEVICES
    return sorted(own.keys() | (installed - package_drivers.OF_ROBOTS))


def _form(name: str, own: Mapping[str, DriverSpec], words: Mapping[str, str]) -> Row:
    try:
        spec = _spec(name, own)
        rows = [vars(each) for each in keys(spec, words)]
    except Exception as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        return {"name": name, "about": "", "keys": [], "why_not": plain(error_text(error), LONGEST)}
    return {"name": name, "about": words.get(name) or _about(spec), "keys": rows, "why_not": ""}


def _spec(name: str, own: Mapping[str, DriverSpec]) -> DriverSpec:
    """The driver of that name: of the plant's own files, or installed."""
    if name in own:
        return own[name]
    point = next(iter(entry_points(group=GROUP).select(name=name)), None)
    if point is None and name in package_drivers.ALL:
        raise ArboledaError(package_drivers.not_installed(name))
    if point is None:
        raise ArboledaError(f"{quoted(name)} is no driver that this plant can name")
    try:
        spec = spec_of(point.load())
    except (Exception, SystemExit) as error:
        raise ArboledaError(
            plain(f"{point.value} cannot be imported: {error_text(error)}", LONGEST)
        ) from error
    if spec is None:
        raise ArboledaError(f"{point.value} is installed as a driver and is none")
    return spec


def _about(spec: DriverSpec) -> str:
    """Description of the settings by their author, else of the driver."""
    for each in (spec.settings, spec.made_by):
        if not isinstance(each, type):
            continue
        text = (each.__doc__ or "").strip()
        if text and not text.startswith(f"{each.__name__}("):  # the docstring that `dataclass` makes
            return plain(" ".join(text.split()), LONGEST)
    return ""


def _key(field: Field[Any], hint: Any, about: str) -> SettingsKey:
    form, choices = _form_of(hint)
    return SettingsKey(
        name=field.name,
        form=form,
        choices=choices,
        required=field.default is MISSING and field.default_factory is MISSING,
        can_be_null=type(None) in get_args(hint),
        default=_default(field.default),
        about=about,
    )


def _form_of(hint: Any) -> tuple[str, tuple[str, ...]]:
    """The sort of field for a type, and the words to choose from."""
    if get_origin(hint) is Annotated:
        return _form_of(get_args(hint)[0])
    if get_origin(hint) in (Union, UnionType):
        inner = [each for each in get_args(hint) if each is not type(None)]
        return _form_of(inner[0]) if len(inner) == 1 else ("yaml", ())
    if isinstance(hint, type) and issubclass(hint, Enum):
        return "choice", tuple(str(each.value) for each in hint)
    if get_origin(hint) is Literal and all(isinstance(each, str) for each in get_args(hint)):
        return "choice", get_args(hint)
    return (FORMS.get(hint, "yaml"), ()) if isinstance(hint, type) else ("yaml", ())


def _default(value: Any) -> str:
    """A default as a person writes it in the field; empty where there is none, or nothing in it."""
    if isinstance(value, Enum):
        return str(value.value)
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        return flow(list(value)) if value else ""
    return flow(value) if isinstance(value, bool | int | float) else ""


def _yaml(name: str, text: str) -> Any:
    try:
        return plain_value(text.encode("utf-8", "replace"))
    except YamlFault as fault:
        raise ArboledaError(f"{name}, line {fault.mark.line}: {fault.sentence}") from None
