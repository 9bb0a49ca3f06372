"""A bit-accurate fixed-point model of GeForce-256-class texture units and register combiners.

>>> import ninebit
>>> scene = ninebit.Scene.load("vectors/scenes/dot3/lit-stone.ron")
>>> scene.render().color[300, 200]
>>> scene.planes("stage0.rgb.AB.r", ideal=True)
>>> print(scene.trace(200, 300))
"""

from __future__ import annotations

import os
from typing import Dict, Tuple, Union

import numpy as np

from . import _native
from .chip import Column, Unit, evaluate, units
from .data import Code, rgba
from .errors import Finding, NinebitError, SceneError
from .frame import Frame, Planes, Trace
from .measures import Accuracy, Comparison, Difference, Region, Statistics
from .scene import Scene

__version__: str = _native.__version__

Picture = Union[np.ndarray, Frame, str, "os.PathLike[str]"]


def picture(source: Picture) -> np.ndarray:
    """Returns a picture as uint8 of (rows, columns, 4): an array, a frame, or a PNG, TGA or DDS file."""
    if isinstance(source, Frame):
        return source.color
    if isinstance(source, np.ndarray):
        return rgba(source)
    width, height, pixels = _native.read_picture(source)
    return pixels.reshape(height, width, 4)


def diff(a: Picture, b: Picture, *, ignore_alpha: bool = False, regions: int = 10) -> Difference:
    """Compares two pictures exactly. The regions are the largest ones of pixels that touch."""
    first, second = picture(a), picture(b)
    found = _native.difference(np.ascontiguousarray(first), np.ascontiguousarray(second), ignore_alpha, regions)
    return Difference.read(found, second.astype(np.int16) - first)


def policies() -> Dict[str, Tuple[str, Dict[str, str]]]:
    """Returns the rules that have alternatives: the question, and each value with its meaning."""
    return {rule: (question, dict(values)) for rule, question, values in _native.policies()}


__all__ = [
    "Accuracy",
    "Code",
    "Column",
    "Comparison",
    "Difference",
    "Finding",
    "Frame",
    "NinebitError",
    "Planes",
    "Region",
    "Scene",
    "SceneError",
    "Statistics",
    "Trace",
    "Unit",
    "diff",
    "evaluate",
    "picture",
    "policies",
    "units",
]
