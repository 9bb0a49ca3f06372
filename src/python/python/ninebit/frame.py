"""What a scene yields: frames, planes, traces."""

from __future__ import annotations

import html
import json
from typing import Any, Dict, Iterator, List, Mapping, Optional, Tuple

import numpy as np

from . import _native


class Frame:
    """A render target after all draws."""

    def __init__(self, drawn: Tuple[Any, ...]) -> None:
        name, form, width, height, words, color, depth, stencil = drawn
        self.name: str = name
        self.format: str = form
        shape = (height, width)
        self.words: np.ndarray = words.reshape(shape)
        """Stored words, uint32 of (rows, columns)."""
        self.color: np.ndarray = color.reshape(height, width, 4)
        """R, G, B, A as a picture shows them, uint8 of (rows, columns, 4)."""
        self.depth: Optional[np.ndarray] = None if depth is None else depth.reshape(shape)
        """Depths, uint32 of (rows, columns); None without a depth buffer."""
        self.stencil: Optional[np.ndarray] = None if stencil is None else stencil.reshape(shape)
        """Stencils, uint8 of (rows, columns); None without a stencil."""

    @property
    def width(self) -> int:
        return int(self.words.shape[1])

    @property
    def height(self) -> int:
        return int(self.words.shape[0])

    def png(self, opaque: bool = True) -> bytes:
        """Returns the picture as a PNG, with an alpha of 255 unless `opaque` is false."""
        color = self.color
        if opaque:
            color = color.copy()
            color[:, :, 3] = 255
        return _native.encode_png(np.ascontiguousarray(color))

    def save(self, path: Any, opaque: bool = True) -> None:
        """Writes the picture as a PNG."""
        with open(path, "wb") as file:
            file.write(self.png(opaque))

    def _repr_png_(self) -> bytes:
        return self.png()

    def __repr__(self) -> str:
        return f"<ninebit.Frame {self.name!r}: {self.width} x {self.height}, {self.format}>"


class Planes(Mapping[str, np.ndarray]):
    """Values of all pixels of a rectangle, by name: int32 of (rows, columns), or (rows, columns, channels) where the name stands for several.

    Values that do not fit are int64. A pixel without a value has 0.
    """

    def __init__(self, names: List[str], width: int, height: int, arrays: List[Tuple[Any, ...]]) -> None:
        self._values: Dict[str, np.ndarray] = {}
        self.present: Dict[str, np.ndarray] = {}
        """Which pixels have a value."""
        self.per_one: Dict[str, np.ndarray] = {}
        """The integer that stands for 1.0; 0 where the integer is the bits of a float32."""
        self.exponent: Dict[str, np.ndarray] = {}
        """The power of two that the integer is multiplied by."""
        self.ideal: Dict[str, np.ndarray] = {}
        """What float64 makes of the value, in the unit of `real`; NaN where there is none. Only if it was asked for."""
        for name, (channels, values, ideals, present, per_one, exponent) in zip(names, arrays):
            shape = (height, width) if channels == 1 else (height, width, channels)
            self._values[name] = values.reshape(shape)
            for found, of in ((present, self.present), (per_one, self.per_one), (exponent, self.exponent)):
                # One number for all pixels, or one for each.
                of[name] = np.broadcast_to(found, shape) if found.size == 1 else found.reshape(shape)
            if ideals is not None:
                self.ideal[name] = ideals.reshape(shape)

    def __getitem__(self, name: str) -> np.ndarray:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def real(self, name: str) -> np.ndarray:
        """Returns the numbers that the integers stand for, float64; NaN where a pixel has none."""
        values, per_one = self._values[name], self.per_one[name]
        with np.errstate(divide="ignore", invalid="ignore"):
            floats = (values.astype(np.int64) & 0xFFFFFFFF).astype(np.uint32).view(np.float32).astype(np.float64)
            numbers = np.ldexp(values.astype(np.float64), self.exponent[name]) / per_one
        numbers = np.where(per_one == 0, floats, numbers)
        return np.where(self.present[name], numbers, np.nan)

    def __repr__(self) -> str:
        return f"<ninebit.Planes: {', '.join(f'{name} {values.shape}' for name, values in self._values.items())}>"


class Trace:
    """How one pixel came to be, integer by integer."""

    def __init__(self, text: str, document: str) -> None:
        self.text = text
        """The trace for people."""
        self.document: Dict[str, Any] = json.loads(document)
        """The trace as docs/trace-format.md describes it."""

    @property
    def word(self) -> int:
        """The word that the surface holds at the end."""
        return int(self.document["word"])

    @property
    def fragments(self) -> List[Dict[str, Any]]:
        """The triangles that cover the pixel, in the order of drawing."""
        return list(self.document["draws"])

    def step(self, name: str, fragment: int = -1) -> Dict[str, Any]:
        """Returns the last step of a name: its rule, operation, inputs, value, real and ideal."""
        for step in reversed(self.document["draws"][fragment]["steps"]):
            if step["name"] == name:
                return dict(step)
        raise KeyError(f"the fragment has no step {name!r}")

    def __getitem__(self, name: str) -> int:
        return int(self.step(name)["value"])

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        rows = []
        for fragment in self.document["draws"]:
            rows.append(f"<tr><th colspan=6 style='text-align:left'>{html.escape(fragment['name'])}, triangle {fragment['triangle']}</th></tr>")
            for step in fragment["steps"]:
                inputs = ", ".join(f"{operand['name']} {operand['value']}" for operand in step["inputs"])
                real, ideal = ("" if step[key] is None else f"{step[key]:.6f}" for key in ("real", "ideal"))
                cells = [step["name"], f"{step['operation']}({inputs})", step["value"], real, ideal, step["rule"]]
                rows.append("<tr>" + "".join(f"<td style='text-align:left'>{html.escape(str(cell))}</td>" for cell in cells) + "</tr>")
        head = "".join(f"<th style='text-align:left'>{name}</th>" for name in ["value", "from", "integer", "real", "ideal", "rule"])
        x, y = self.document["pixel"]
        return f"<details open><summary>pixel {x},{y}</summary><table><tr>{head}</tr>{''.join(rows)}</table></details>"
