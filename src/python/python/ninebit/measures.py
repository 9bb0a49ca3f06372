"""Errors: against the truth of a scene, against ideal arithmetic, between pictures."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple

import numpy as np


@dataclass(frozen=True)
class Statistics:
    """Statistics of errors, in steps of 1/255."""

    count: int
    rms: float
    mean: float
    """Of absolute errors."""
    bias: float
    """Of errors with their signs."""
    max: float
    """Of absolute errors."""
    low: float
    high: float
    psnr: Optional[float]
    """In decibels; None without an error."""

    @classmethod
    def read(cls, fields: Dict[str, Any]) -> "Statistics":
        return cls(**{name: fields[name] for name in cls.__dataclass_fields__})


@dataclass(frozen=True)
class Accuracy:
    """How far a picture is from what it ought to show."""

    errors: Statistics
    """Of all channels together."""
    channels: Dict[str, Statistics]
    causes: Dict[str, Statistics]
    """The same errors by their cause: method, interpolation, filtering, expansion, product and sum, store; quantised normals."""
    truth: np.ndarray
    """What the picture ought to show, 0 to 255, float64 of (rows, columns, 3); NaN where there is no truth."""
    error: np.ndarray
    """The picture minus the truth in steps of 1/255, float64 of (rows, columns, 3)."""
    document: Dict[str, Any]
    """Everything that `ninebit measure --format json` prints of a scene."""

    @classmethod
    def read(cls, text: str, size: Tuple[int, int], shown: np.ndarray, truth: np.ndarray) -> "Accuracy":
        document = json.loads(text)
        truth = truth.reshape(*size, 3)
        color = shown.reshape(*size, 4)
        return cls(
            errors=Statistics.read(document["errors"]),
            channels={name: Statistics.read(fields) for name, fields in document["channels"].items()},
            causes={fields["cause"]: Statistics.read(fields) for fields in document["causes"]},
            truth=truth,
            error=color[:, :, :3] - truth,
            document=document,
        )


@dataclass(frozen=True)
class Comparison:
    """A picture held against the same scene in ideal float64 arithmetic."""

    mode: str
    drawn: int
    """Number of pixels that something was drawn to."""
    left_out: int
    """Number of pixels at which the ideal decided differently."""
    channels: Dict[str, Statistics]
    rules: List[Dict[str, Any]]
    decisions: List[Dict[str, Any]]
    error: np.ndarray
    """The picture minus the ideal in steps, float32 of (rows, columns, 4): NaN where nothing is compared, infinite where decisions differ."""
    document: Dict[str, Any]
    """Everything that `ninebit compare --format json` prints."""

    @classmethod
    def read(cls, text: str, errors: np.ndarray) -> "Comparison":
        document = json.loads(text)
        shape = (document["height"], document["width"], 4)
        return cls(
            mode=document["mode"],
            drawn=document["drawn"],
            left_out=document["left_out"],
            channels={name: Statistics.read(fields) for name, fields in document["channels"].items()},
            rules=document["rules"],
            decisions=document["decisions"],
            error=errors.reshape(shape) if errors.size else np.full(shape, np.nan, np.float32),
            document=document,
        )


@dataclass(frozen=True)
class Region:
    """Differing pixels that touch, corners included."""

    x: int
    y: int
    width: int
    height: int
    pixels: int


@dataclass(frozen=True)
class Difference:
    """Two pictures compared exactly."""

    different: int
    """Number of pixels that differ."""
    largest: int
    """Largest difference of a channel."""
    channels: Dict[str, Tuple[int, int]]
    """For each channel how many pixels differ in it, and by how much at most."""
    regions: List[Region]
    region_count: int
    error: np.ndarray
    """The second picture minus the first, int16 of (rows, columns, 4)."""

    @classmethod
    def read(cls, found: Dict[str, Any], error: np.ndarray) -> "Difference":
        return cls(
            different=found["different"],
            largest=found["largest"],
            channels={name: (count, largest) for name, count, largest in found["channels"]},
            regions=[Region(*region) for region in found["regions"]],
            region_count=found["region_count"],
            error=error,
        )

    def __bool__(self) -> bool:
        return self.different > 0
