"""Plain Python data and arrays as scenes."""

from __future__ import annotations

from typing import Any, Dict, Tuple

import numpy as np

from . import _native


class Code(str):
    """A value as a scene file has it, ``Code("Float(1, 0)")``: it is not put in quotes."""


def plain(value: Any) -> Any:
    """Returns a value with arrays and NumPy's numbers as lists, tuples and Python's numbers. The last axis of an array becomes tuples."""
    if isinstance(value, np.ndarray):
        if value.dtype.names:
            return {name: plain(value[name]) for name in value.dtype.names}
        items = value.tolist()
        return nested(items, value.ndim) if value.ndim > 1 else items
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    if isinstance(value, tuple):
        return tuple(plain(item) for item in value)
    return value


def nested(items: Any, depth: int) -> Any:
    return tuple(items) if depth == 1 else [nested(item, depth - 1) for item in items]


def text_of(value: Any) -> str:
    """Returns the text of a value. A str is the text itself; a tuple is values in parentheses, a list in brackets."""
    return value if isinstance(value, str) else _native.value_text(plain_vector(value))


def plain_vector(value: Any) -> Any:
    """Returns an array of one axis as a vector, which scenes write in parentheses."""
    return tuple(value.tolist()) if isinstance(value, np.ndarray) and value.ndim == 1 else plain(value)


def scene_of(data: Dict[str, Any]) -> Tuple[str, Dict[str, bytes]]:
    """Returns the text of a scene and its files. An array as the ``source`` of a texture becomes a file.

    uint8 of (rows, columns, 3 or 4) are R, G, B, A; other integers of (rows, columns) are words of the texture's ``format``.
    """
    data = dict(data)
    files: Dict[str, bytes] = {}
    textures = {}
    for name, texture in data.get("textures", {}).items():
        if isinstance(texture, np.ndarray):
            texture = {"source": texture}
        texture = dict(texture)
        source = texture.get("source")
        if isinstance(source, np.ndarray):
            file = f"array-{len(files)}.{'png' if source.ndim == 3 else 'bin'}"
            rows, columns = source.shape[:2]
            if source.ndim == 3:
                files[file] = _native.encode_png(rgba(source))
                texture["source"] = {"File": (file,)}
            else:
                files[file] = np.ascontiguousarray(source.astype(source.dtype.newbyteorder("<"))).tobytes()
                texture["source"] = {"Raw": {"file": file, "width": columns, "height": rows}}
        textures[name] = texture
    if textures:
        data["textures"] = textures
    data.setdefault("version", 1)
    return _native.scene_text(plain(data)), files


def rgba(pixels: np.ndarray) -> np.ndarray:
    """Returns a picture as uint8 of (rows, columns, 4). Grey becomes R, G and B; a missing alpha is 255."""
    pixels = np.asarray(pixels)
    if pixels.dtype != np.uint8:
        raise TypeError(f"a picture is an array of uint8, not of {pixels.dtype}")
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[:, :, None], 3, axis=2)
    if pixels.ndim != 3 or pixels.shape[2] not in (3, 4):
        raise ValueError(f"a picture has rows, columns, and 3 or 4 channels; this array has the shape {pixels.shape}")
    if pixels.shape[2] == 3:
        pixels = np.concatenate([pixels, np.full_like(pixels[:, :, :1], 255)], axis=2)
    return np.ascontiguousarray(pixels)
