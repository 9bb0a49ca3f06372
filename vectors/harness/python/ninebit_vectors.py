"""Reads packs of vectors. Standard library only; Python 3.8 or later. Dedicated to the public domain (CC0 1.0).

    pack = Pack("pack")
    for row in pack.table("sum"):
        if my_sum(row["in.a"], row["in.b"]) != row["out.sum"]:
            print(row)
"""

import hashlib
import json
from fractions import Fraction
from pathlib import Path

FORMAT = "# ninebit-vectors 1"


class VectorError(Exception):
    """A file is missing, cut off, changed, or of another version; the message says which and where."""


def _value(kind, text):
    """A field by the letter of its column's type."""
    if kind == "x":
        return int(text, 16)
    if kind == "h":
        return Fraction(text)
    if kind in ("u", "s"):
        return int(text)
    return text


class Table:
    """The rows of a unit; iterating gives a dictionary a row, by the names of the columns.

    Numbers are int, halves are Fraction, names, id, tags, grade, reach and alternatives are str. `line` is the row's line in the file.
    """

    def __init__(self, path):
        self.path = Path(path)
        self.header = {}
        self.names = []
        self._kinds = []
        self._first = 0
        with self._open() as file:
            for number, line in enumerate(file, 1):
                line = line.rstrip("\n")
                if number == 1 and line != FORMAT:
                    raise VectorError(f"{self.path}: the first line is not `{FORMAT}`")
                if not line.startswith("#"):
                    self.names = line.split("\t")
                    self._first = number + 1
                    break
                key, _, value = line[2:].partition(" ")
                self.header[key] = value
        kinds = [kind[0] for kind in self.header.get("types", "").split()]
        if not self.names or not kinds or len(kinds) >= len(self.names):
            raise VectorError(f"{self.path}: the names or the types of the columns are missing")
        # The id comes before the typed columns, four columns of text after them.
        self._kinds = ["t", *kinds, *["t"] * (len(self.names) - len(kinds) - 1)]
        self.unit = self.header["unit"]

    def _open(self):
        try:
            return open(self.path, encoding="utf-8", newline="\n")
        except OSError as error:
            raise VectorError(f"{self.path}: {error.strerror}") from error

    def __iter__(self):
        with self._open() as file:
            for number, line in enumerate(file, 1):
                if number < self._first:
                    continue
                fields = line[:-1].split("\t")
                if not line.endswith("\n") or len(fields) != len(self.names):
                    raise VectorError(f"{self.path}, line {number}: cut off, or not as many fields as columns")
                try:
                    row = {name: _value(kind, text) for name, kind, text in zip(self.names, self._kinds, fields)}
                except ValueError as error:
                    raise VectorError(f"{self.path}, line {number}: {error}") from error
                row["line"] = number
                yield row


class Pack:
    """A folder with a manifest. Opening it compares every file with its SHA-256."""

    def __init__(self, folder):
        self.folder = Path(folder)
        try:
            self.manifest = json.loads((self.folder / "MANIFEST.json").read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise VectorError(f"{self.folder / 'MANIFEST.json'}: {error}") from error
        if self.manifest.get("format") != "ninebit-vectors-1":
            raise VectorError(f"{self.folder}: the pack is of another version")
        for file in self.manifest["files"]:
            path = self.folder / file["path"]
            try:
                digest = hashlib.sha256(path.read_bytes()).hexdigest()
            except OSError as error:
                raise VectorError(f"{path}: {error.strerror}; the pack is not whole") from error
            if digest != file["sha256"]:
                raise VectorError(f"{path}: not the file that the manifest lists")

    def units(self):
        """Names of the units."""
        return sorted(file["unit"] for file in self.manifest["files"] if file["path"].endswith(".tsv"))

    def table(self, unit):
        """The table of a unit."""
        return Table(self.folder / "units" / f"{unit}.tsv")


def show(row):
    """A row as text: its id and line, then configuration, inputs, intermediates and results."""
    groups = ("cfg.", "in.", "mid.", "out.")
    numbers = [f"{name}={value}" for name, value in row.items() if name.startswith(groups)]
    return f"row {row['id']} (line {row['line']}): {' '.join(numbers)}"
