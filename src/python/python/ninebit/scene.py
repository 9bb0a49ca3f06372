"""Scenes: read, change, draw, trace, measure."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from . import _native
from .data import scene_of, text_of
from .errors import Finding
from .frame import Frame, Planes, Trace
from .measures import Accuracy, Comparison

Policies = Union[Mapping[str, str], Sequence[str], None]


def policy_texts(policies: Policies) -> List[str]:
    if policies is None:
        return []
    if isinstance(policies, Mapping):
        return [f"{rule}={value}" for rule, value in policies.items()]
    return [policies] if isinstance(policies, str) else list(policies)


class Scene:
    """A scene, from its text or from plain data.

    `scene` is the text of a scene, or a dictionary with the fields of the scene format: dictionaries are structures and tables, a dictionary with one
    entry is a word with its value (``{"Window": [...]}``), strings are words or names, and arrays stand for lists of vectors, for vertices
    (``{"position": array, "diffuse": array}``) and for texels.

    `base` is the folder of the files that the scene names; `files` holds files in memory by name.
    """

    def __init__(
        self,
        scene: Union[str, Dict[str, Any]],
        base: Union[str, "os.PathLike[str]"] = ".",
        files: Optional[Mapping[str, bytes]] = None,
    ) -> None:
        self._files: Dict[str, bytes] = dict(files or {})
        if isinstance(scene, str):
            self._text: Optional[str] = scene
        else:
            self._text, made = scene_of(scene)
            self._files.update(made)
        self._origin = Path(base) / "scene.ron"
        self._changes: Dict[str, str] = {}
        self._read: Optional[_native.Scene] = None
        self._native()

    @classmethod
    def load(cls, path: Union[str, "os.PathLike[str]"]) -> "Scene":
        """Reads a scene file."""
        scene = cls.__new__(cls)
        scene._files, scene._text, scene._origin = {}, None, Path(path)
        scene._changes, scene._read = {}, None
        scene._native()
        return scene

    def _native(self) -> _native.Scene:
        if self._read is None:
            changes = list(self._changes.items())
            if self._text is None:
                self._read = _native.Scene.load(self._origin, changes)
            else:
                self._read = _native.Scene.parse(self._text, self._origin, self._files, changes)
        return self._read

    def set(self, path: str, value: Any) -> "Scene":
        """Puts a value at a path, ``draws[0].program.constants[0]``, and returns the scene. What the family has is changed, too.

        A string is the value as a scene file has it; a tuple or an array of one axis is values in parentheses, a list is one in brackets.
        If the scene is refused with the value, it stays as it was.
        """
        before, read = self._changes, self._read
        self._changes = {**before, path: text_of(value)}
        self._read = None
        try:
            self._native()
        except Exception:
            self._changes, self._read = before, read
            raise
        return self

    def copy(self) -> "Scene":
        """Returns a scene of its own with the same changes."""
        scene = Scene.__new__(Scene)
        scene._files, scene._text, scene._origin = dict(self._files), self._text, self._origin
        scene._changes, scene._read = dict(self._changes), self._read
        return scene

    @property
    def text(self) -> str:
        """The text of the scene after its changes, without that of its family."""
        return self._native().text

    @property
    def profile(self) -> str:
        """The chip, "Nv10" or "Nv2a"."""
        return self._native().profile

    @property
    def targets(self) -> List[Tuple[str, str, int, int]]:
        """Name, format, width and height of each render target."""
        return self._native().targets

    @property
    def draws(self) -> List[str]:
        """Names of the draws."""
        return self._native().draws

    @property
    def warnings(self) -> List[Finding]:
        """What is probably not intended."""
        return [Finding(**fields) for fields in self._native().warnings]

    def render(
        self,
        target: Optional[str] = None,
        *,
        engine: str = "fast",
        isa: Optional[str] = None,
        threads: int = 0,
        policies: Policies = None,
        work: Optional[int] = None,
    ) -> Frame:
        """Draws the scene and returns a target, the first unless one is named.

        `threads` is their number, 0 for one a core. `policies` chooses alternatives of rules, ``{"CMB-3": "literal"}``. `work` is the number of shaded
        pixels above which a scene is refused.
        """
        frames = self.render_all(engine=engine, isa=isa, threads=threads, policies=policies, work=work)
        if target is None:
            return next(iter(frames.values()))
        if target not in frames:
            raise KeyError(f"the scene has no target {target!r}; it has {', '.join(frames)}")
        return frames[target]

    def render_all(
        self,
        *,
        engine: str = "fast",
        isa: Optional[str] = None,
        threads: int = 0,
        policies: Policies = None,
        work: Optional[int] = None,
    ) -> Dict[str, Frame]:
        """Draws the scene and returns all targets by name."""
        drawn = self._native().render(engine, isa, threads, policy_texts(policies), work)
        return {frame.name: frame for frame in map(Frame, drawn)}

    def plane_names(self, target: Optional[str] = None) -> Dict[str, str]:
        """Returns the names of values that some pixels have, each with its block of the chip."""
        return dict(self._native().plane_names(target))

    def planes(
        self,
        *names: str,
        target: Optional[str] = None,
        rectangle: Optional[Tuple[int, int, int, int]] = None,
        draw: Optional[int] = None,
        dropped: bool = False,
        ideal: bool = False,
        threads: int = 0,
        policies: Policies = None,
        work: Optional[int] = None,
    ) -> Planes:
        """Returns values that traces name, of all pixels: ``planes("stage0.rgb.AB.r", "texture0.rgb")["texture0.rgb"]``.

        A name that ends before the channel, ``stage0.rgb.AB``, stands for its channels. `rectangle` is first column, first row, columns, rows. A pixel's
        value is that of its last stored fragment, of `draw` alone if that is given; with `dropped` fragments count that a test drops.
        `fragment.draw`, `fragment.triangle` and `fragment.stored` say of which fragment the values are.
        """
        width, height, arrays = self._native().planes(
            list(names), target, rectangle, draw, dropped, ideal, threads, policy_texts(policies), work
        )
        return Planes(list(names), width, height, arrays)

    def trace(
        self,
        x: int,
        y: int,
        *,
        target: Optional[str] = None,
        draw: Optional[int] = None,
        policies: Policies = None,
        work: Optional[int] = None,
    ) -> Trace:
        """Returns how the pixel in column `x` and row `y` came to be."""
        return Trace(*self._native().trace((x, y), target, draw, policy_texts(policies), work))

    def measure(self, *, policies: Policies = None, work: Optional[int] = None) -> Accuracy:
        """Measures the picture against the scene's truth."""
        return Accuracy.read(*self._native().measure(policy_texts(policies), work))

    def compare(
        self,
        mode: str = "free",
        *,
        target: Optional[str] = None,
        threads: int = 0,
        policies: Policies = None,
        work: Optional[int] = None,
    ) -> Comparison:
        """Compares the picture with ideal arithmetic. In the mode "free" the ideal decides everything, in "follow" nothing; "per-op" restarts it at each rule."""
        return Comparison.read(*self._native().compare(mode, target, threads, policy_texts(policies), work))

    def _repr_png_(self) -> bytes:
        return self.render().png()

    def __repr__(self) -> str:
        name, form, width, height = self.targets[0]
        return f"<ninebit.Scene: {len(self.draws)} draws for {self.profile}, target {name!r}, {width} x {height}, {form}>"

