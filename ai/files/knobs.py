"""Settings as a dataclass whose fields describe themselves, for commands, screens and files alike.

A field's metadata hold a sentence of help, its group, its range, and whether it may change while a run goes on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from typing import Any, Self

from ai.files.reading import shown
from ai.files.schema import check_field


def knob(
    default: Any,
    help: str,  # noqa: A002 - the usual name wherever options are described
    group: str,
    *,
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] = (),
    log: bool = False,
    live: bool = False,
    offers: tuple[Any, ...] = (),
    needs: str = "",
    compare: bool = True,
) -> Any:
    """Describe a field: its help, group, range or choices, scale, and whether it may change during a run.

    `offers` are a few values for a screen to propose, where the range says too little. `needs` names another field:
    while that is off or 0, this one has no effect. `compare` is off for what is a name, and makes no difference.
    """
    described = locals().copy()
    return field(default=described.pop("default"), compare=described.pop("compare"), metadata=described)


@dataclass(frozen=True)
class Knobs:
    """Base class of settings whose fields are all `knob`s; values out of range raise ValueError, which names all.

    Settings know by name which preset they began as, however they are changed.
    """

    preset: str = knob("modern", "Preset that these settings began as.", "learning", compare=False)

    def __post_init__(self) -> None:
        if problems := self.problems():
            raise ValueError("; ".join(problems))

    def problems(self) -> list[str]:
        """Return what is wrong with the values, a sentence each."""
        return [problem for item in fields(self) if (problem := self.problem_of(item.name, getattr(self, item.name)))]

    def unused(self) -> list[str]:
        """Return the names of the fields that change nothing because another one is off or 0."""
        return [item.name for item in fields(self) if (other := item.metadata["needs"]) and not getattr(self, other)]

    def to_json(self) -> dict[str, Any]:
        """Return the values as JSON can hold them, by field."""
        return asdict(self)

    def differences(self, other: Self) -> dict[str, Any]:
        """Return the values that `other` does not have, by field, as JSON can hold them."""
        mine, theirs = self.to_json(), other.to_json()
        compared = [item.name for item in fields(self) if item.compare]
        return {name: mine[name] for name in compared if mine[name] != theirs[name]}

    def described(self, presets: Mapping[str, Self]) -> dict[str, Any]:
        """Return the name of its preset, or of the first where there is none of that name, and what differs from it."""
        preset = self.preset if self.preset in presets else next(iter(presets))
        return {"preset": preset, "changes": self.differences(presets[preset])}

    @classmethod
    def problem_of(cls, name: str, value: Any) -> str:
        """Say what is wrong with a value of a field; empty if nothing is."""
        try:
            check_field(cls, name, value)
        except ValueError as error:
            return str(error)
        described = next(item for item in fields(cls) if item.name == name).metadata
        if described["choices"] and value not in described["choices"]:
            return f"{name} is one of {', '.join(described['choices'])}, not {shown(value)}"
        numbers, low, high = value if isinstance(value, tuple) else (value,), described["low"], described["high"]
        if low is not None and not (numbers and all(low <= number <= high for number in numbers)):
            return f"{name} lies between {low:g} and {high:g}, not {shown(value)}"
        return ""

    @classmethod
    def from_json(cls, values: Any) -> Self:
        """Read what `to_json` wrote; raises ValueError for unknown names and bad values."""
        if not isinstance(values, Mapping):
            raise ValueError(f"settings are values by name, not {shown(values)}")
        if unknown := sorted(set(values) - cls.names()):
            raise ValueError(f"unknown settings: {', '.join(unknown)}")
        return cls(**{name: cls.value_from_json(name, value) for name, value in values.items()})

    @classmethod
    def names(cls) -> set[str]:
        """Return the names of all fields."""
        return {item.name for item in fields(cls)}

    @classmethod
    def value_from_json(cls, name: str, value: Any) -> Any:  # noqa: ARG003
        """Return the value of a field from what a file holds of it; raises ValueError for what cannot be one."""
        return tuple(value) if isinstance(value, list) else value

    def changed(self, **values: Any) -> Self:
        """Return a copy with some fields changed, checked like any other."""
        return replace(self, **values)

    def turned(self, name: str, value: Any) -> Self:
        """Return a copy with one live knob turned, named by its field, or "field.part" where that has parts.

        Raises ValueError for a name that no setting has, for one that is not live, and for a value out of range.
        """
        head, _, part = name.partition(".")
        live = {item.name: item.metadata["live"] for item in fields(self)}
        whole = getattr(self, head) if head in live else None
        if head not in live or (part and (not is_dataclass(whole) or part not in vars(whole))):
            raise ValueError(f"there is no setting called {name}")
        if not live[head]:
            raise ValueError(f"{head} cannot change while a run goes on")
        return self.changed(**{head: replace(whole, **{part: value}) if part else value})  # type: ignore[type-var]

    @classmethod
    def live_names(cls) -> tuple[str, ...]:
        """Return the names of the fields that may change while a run goes on."""
        return tuple(item.name for item in fields(cls) if item.metadata["live"])

    def with_live(self, other: Self) -> Self:
        """Return these settings with the live fields of `other`; all the rest stay as they are."""
        return self.changed(**{name: getattr(other, name) for name in self.live_names()})

    def fixed_differences(self, other: Self) -> list[str]:
        """Return the names of the fields in which `other` differs although a run cannot change them."""
        return list(self.with_live(other).differences(other))
