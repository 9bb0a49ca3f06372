"""Programs and units on arrays, without a scene."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Mapping, Optional, Union

import numpy as np

from . import _native
from .errors import NinebitError
from .scene import Policies, policy_texts


def evaluate(
    program: Union[str, Mapping[Union[str, int], int]],
    inputs: Mapping[str, Any],
    *,
    language: str = "combiners",
    profile: str = "nv2a",
    policies: Policies = None,
) -> Dict[str, np.ndarray]:
    """Runs a pixel program on arrays of registers.

    `program` is a text in a language that `ninebit lower --from` reads, or register words: a dictionary from name or method to word. `inputs` holds
    an array for each register that a pixel brings, `primary`, `secondary`, `fog` (0 to 255) and `texture0` to `texture3` (-256 to 255); the last axis
    is R, G, B, A, and the others are broadcast. 255 is 1.0. Registers that are not given hold 0.

    Returns the registers that the program writes, and `fragment`, the colour that reaches the raster operations: int16 in the same form.
    """
    if not isinstance(program, str):
        lines = [f"{key if isinstance(key, str) else f'{key:#06x}'} {word:#010x}" for key, word in program.items()]
        program, language = "\n".join(lines), "registers"
    arrays = {name: np.asarray(value) for name, value in inputs.items()}
    for name, array in arrays.items():
        if array.dtype.kind not in "iub" or array.ndim == 0 or array.shape[-1] != 4:
            raise NinebitError(f"`{name}` is an array of {array.dtype} with the shape {array.shape}", help="pass integers whose last axis is R, G, B, A")
    shape = np.broadcast_shapes(*(array.shape for array in arrays.values())) if arrays else (4,)
    given = []
    for name, array in arrays.items():
        if array.dtype.itemsize > 1 and array.dtype != np.int16 and array.size and (array.min() < -32768 or array.max() > 32767):
            raise NinebitError(f"`{name}` holds -256 to 255", help="255 is 1.0; clip the array")
        given.append((name, np.ascontiguousarray(np.broadcast_to(array, shape), np.int16).ravel()))
    pixels = int(np.prod(shape[:-1], dtype=np.int64))
    found = _native.evaluate(program, language, given, pixels, profile, policy_texts(policies))
    return {name: values.reshape(shape) for name, values in found.items()}


@dataclass(frozen=True)
class Column:
    """A column of a unit."""

    name: str
    names: Optional[List[str]]
    """What its numbers are called: a number is the index in this list."""
    least: int
    greatest: int
    default: Optional[int]
    """The number of an input that is not given; None if it has to be."""


class Unit:
    """A unit of the chip: a function from integers to integers."""

    def __init__(self, name: str) -> None:
        self._unit = _native.unit(name)
        self.name = name
        self.about: str = self._unit.about
        """What it does."""
        self.rules: List[str] = self._unit.rules
        """Ids of its rules."""
        self.inputs = [Column(*fields) for fields in self._unit.inputs()]
        self.results = [Column(*fields) for fields in self._unit.results()]

    def __call__(
        self, columns: Mapping[str, Any] = {}, *, profile: str = "nv2a", policies: Policies = None, **named: Any
    ) -> Dict[str, np.ndarray]:
        """Evaluates rows. `columns` holds integers, words or arrays by the name of a column, broadcast against each other; a name may be
        written without what stands before its first dot. Returns int64 arrays by the names of the results."""
        given = {**columns, **named}
        known: Dict[str, Column] = {}
        for column in self.inputs:
            known[column.name] = known[column.name.split(".", 1)[-1]] = column
        for name in given:
            if name not in known:
                names = ", ".join(column.name for column in self.inputs)
                raise NinebitError(f"`{self.name}` has no input `{name}`", help=f"its inputs are {names}")
        by_column = {known[name].name: value for name, value in given.items()}
        values = []
        for column in self.inputs:
            value = by_column.get(column.name, column.default)
            if value is None:
                raise NinebitError(f"`{column.name}` is not given", help=f"pass {column.names or f'{column.least} to {column.greatest}'}")
            if isinstance(value, str):
                if value not in (column.names or []):
                    raise NinebitError(f"`{column.name}` cannot be {value!r}", help=f"pass {column.names or 'integers'}")
                value = (column.names or []).index(value)
            array = np.asarray(value)
            if array.dtype.kind not in "iub":
                raise NinebitError(f"`{column.name}` is an array of {array.dtype}", help="pass integers")
            values.append(array)
        shape = np.broadcast_shapes(*(value.shape for value in values))
        flat = [np.ascontiguousarray(np.broadcast_to(value, shape), np.int64).ravel() for value in values]
        found = self._unit.evaluate(flat, profile, policy_texts(policies))
        return {name: array.reshape(shape) for name, array in found.items()}

    def __repr__(self) -> str:
        return f"<ninebit.Unit {self.name}: {self.about}>"


class Units(Mapping[str, Unit]):
    """All units of the chip, by name."""

    def __getitem__(self, name: str) -> Unit:
        if name not in _native.unit_names():
            raise KeyError(name)
        return Unit(name)

    def __iter__(self) -> Iterator[str]:
        return iter(_native.unit_names())

    def __len__(self) -> int:
        return len(_native.unit_names())


units = Units()
