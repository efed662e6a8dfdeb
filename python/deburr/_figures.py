# SPDX-License-Identifier: MIT
"""Named figures, accessible as attributes and as items."""
import collections.abc
import typing


class Figures(collections.abc.Mapping[str, typing.Any]):
    """Read-only named values: `figures.cycles`, `figures["cycles"]`. Groups are Figures too, and a key may name a
    nested value: `figures["units.filter_pipeline.busy"]`."""

    def __init__(self, values: collections.abc.Mapping[str, typing.Any]) -> None:
        self.__dict__["_values"] = {name: Figures(value) if isinstance(value, dict) else value
                                    for name, value in values.items()}

    def __getitem__(self, name: str) -> typing.Any:
        if name in self._values:
            return self._values[name]
        # Keys may contain dots: takes the first split that exists.
        parts = str(name).split(".")
        for count in range(1, len(parts)):
            inner = self._values.get(".".join(parts[:count]))
            rest = ".".join(parts[count:])
            if isinstance(inner, Figures) and rest in inner:
                return inner[rest]
        raise KeyError(name)

    def __contains__(self, name: object) -> bool:
        try:
            self[str(name)]
        except KeyError:
            return False
        return True

    def __getattr__(self, name: str) -> typing.Any:
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"unknown figure '{name}' (known: {', '.join(self._values)})") from None

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError("figures cannot be changed")

    def __getstate__(self) -> dict[str, typing.Any]:
        values: dict[str, typing.Any] = self._values
        return values

    def __setstate__(self, values: dict[str, typing.Any]) -> None:
        self.__dict__["_values"] = values

    def __iter__(self) -> collections.abc.Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(name for name in self._values if name.isidentifier())]

    def __repr__(self) -> str:
        return "Figures(" + ", ".join(f"{name}={value!r}" for name, value in self._values.items()) + ")"

    def as_dict(self) -> dict[str, typing.Any]:
        """Returns the same as plain dictionaries."""
        return {name: value.as_dict() if isinstance(value, Figures) else value for name, value in self._values.items()}
