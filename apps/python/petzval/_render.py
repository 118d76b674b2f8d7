# SPDX-License-Identifier: Apache-2.0
"""Scenes, cameras and images. _fields.py gives their functions a keyword for each field."""
from __future__ import annotations

import atexit
import json
import os
import tempfile
import time
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core  # type: ignore[attr-defined]
from ._arrays import Light, Mesh, write_glb
from ._errors import Error, FieldError
from ._keywords import FIELDS, Fields, Files, Texts, encoded, matrix, naming_field, path_text, whole
from ._lens import Lens

if TYPE_CHECKING:
    from ._fields import Camera, Scene

OPENCV_TO_GLTF = np.diag([1.0, -1.0, -1.0, 1.0])
_SESSIONS: weakref.WeakSet[Any] = weakref.WeakSet()


@dataclass(frozen=True)
class Progress:
    """How far a render is. total: 0 where it is not known. noise: of the picture so far, 0 where none is asked for."""

    phase: str
    pixel_samples: int
    total: int
    noise: float
    elapsed_s: float

    @property
    def fraction(self) -> float:
        """Share of the samples that there will be; 0 where it is not known."""
        return self.pixel_samples / self.total if self.total else 0.0


OnProgress = Callable[[Progress], object]


class SceneBase:
    """A glTF file, which is loaded at the first render and kept for the next ones."""

    def __init__(self, file: str | os.PathLike[str], threads: int, values: Mapping[str, Any]) -> None:
        self.path = path_text("file", file)
        self.threads = whole("threads", threads, 0, _core.MOST_THREADS)
        self._fields = Fields(values)
        self._session: Any = None
        self._arrays: tuple[list[Mesh], list[Light], Files] | None = None

    @classmethod
    def from_arrays(cls, meshes: Iterable[Mesh], lights: Iterable[Light] = (), **values: Any) -> Scene:
        """Scene of these meshes and lights, in metres, y up, by way of a glTF file in a folder of its own.

        values: as those of Scene; env may be an array (height, width, 3) of a sky in nits.
        """
        meshes, lights, files = list(meshes), list(lights), Files()
        path = files.folder() / "scene.glb"
        write_glb(path, meshes, lights)
        scene: Scene = cls(path, **values)  # type: ignore[arg-type, assignment]
        scene._arrays = (meshes, lights, files)
        return scene

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = self._arrays[:2] if self._arrays else None
        return _remade_scene, (type(self), self.path, arrays, {"threads": self.threads, **self._fields.values})

    def __repr__(self) -> str:
        return f"Scene({', '.join(filter(None, (repr(self.path), str(self._fields))))})"

    def session(self) -> Any:
        """What renders."""
        if not self._session:
            self._session = _core.Session(self.threads)
            _SESSIONS.add(self._session)
        return self._session


def _remade_scene(cls: Any, path: str, arrays: tuple[list[Mesh], list[Light]] | None, values: dict[str, Any]) -> Any:
    return cls.from_arrays(*arrays, **values) if arrays else cls(path, **values)


@atexit.register
def _close() -> None:
    """Ends renders of other threads before Python goes."""
    for session in list(_SESSIONS):
        session.close()


class CameraBase:
    """Where a picture is taken from and through which lens; what is not given is as the scene's file has it."""

    def __init__(self, axes: str, values: Mapping[str, Any]) -> None:
        if axes not in ("gltf", "opencv"):
            raise FieldError(f'axes: "{axes}" is neither "gltf" nor "opencv"', "axes")
        out = _with_lens(values)
        if axes == "opencv" and out.get("pose") is not None:
            out["pose"] = matrix("pose", out["pose"]) @ OPENCV_TO_GLTF
        self._fields = Fields(out)

    def __reduce__(self) -> tuple[Any, ...]:
        return _remade_camera, (type(self), self._fields.values)

    def __repr__(self) -> str:
        return f"Camera({self._fields})"


def _remade_camera(cls: Any, values: dict[str, Any]) -> Any:
    return cls(**values)


def _with_lens(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values with what a Lens among them says."""
    out = dict(values)
    if isinstance(lens := out.get("lens"), Lens):
        for keyword, value in lens.keywords().items():
            if keyword == "lens" or out.get(keyword) is None:
                out[keyword] = value
    return out


class Image:
    """A rendered picture. Arrays share its memory and cannot be written to; copy() gives one that can."""

    def __init__(self, core: Any) -> None:
        self._core = core
        self._places: dict[str, list[int]] = {}
        for place, name in enumerate(core.channels):
            layer = "pixels" if name in "RGBA" else name if name == "denoised.error" else name.split(".")[0]
            self._places.setdefault(layer, []).append(place)

    def _layer(self, name: str) -> NDArray[np.float32] | None:
        if name not in self._places:
            return None
        places = self._places[name]  # which follow each other
        array: NDArray[np.float32] = self._core.values[..., places[0]:places[-1] + 1]
        return array[..., 0] if name in ("depth", "denoised.error", "samples", "cost") else array

    @property
    def pixels(self) -> NDArray[np.float32]:
        """R, G, B in nits of the white point, and alpha: (height, width, 4), linear."""
        pixels = self._layer("pixels")
        assert pixels is not None
        return pixels

    @property
    def rgb(self) -> NDArray[np.float32]:
        """The denoised R, G, B where denoise was asked for, else those of pixels: (height, width, 3)."""
        denoised = self._layer("denoised")
        return self.pixels[..., :3] if denoised is None else denoised

    @property
    def bins(self) -> NDArray[np.float32] | None:
        """Mean radiance in each bin, W / (m2 sr nm): (height, width, bins). None without bins."""
        return self._layer("S0")

    @property
    def bin_edges_nm(self) -> NDArray[np.float64] | None:
        """Edges of the bins: (bins + 1,)."""
        bins = self.bins
        if bins is None:
            return None
        first, last, _ = str(self.metadata["petzval:bins"]).split(":")
        return np.linspace(float(first), float(last), bins.shape[2] + 1)

    @property
    def standard_error(self) -> NDArray[np.float32] | None:
        """Standard errors of R, G and B: (height, width, 3). None without bins or noise."""
        return self._layer("stderr")

    @property
    def denoised_error(self) -> NDArray[np.float32] | None:
        """Stated relative error of the denoised picture about each pixel: (height, width). None without denoise."""
        return self._layer("denoised.error")

    @property
    def samples(self) -> NDArray[np.float32] | None:
        """Samples of each pixel: (height, width). None where all have the same number."""
        return self._layer("samples")

    @property
    def layers(self) -> dict[str, NDArray[np.float32]]:
        """Other layers by name, (height, width, channels), as albedo, normal and XYZ; depth is (height, width)."""
        own = {"pixels", "S0", "stderr", "denoised", "denoised.error", "samples"}
        found = {name: self._layer(name) for name in self._places if name not in own}
        return {name: layer for name, layer in found.items() if layer is not None}

    @property
    def metadata(self) -> dict[str, int | float | str]:
        """What the EXR says: name by name."""
        return dict(self._core.metadata)

    @property
    def notices(self) -> list[str]:
        """What was chosen for you, and what is odd in the scene: a line each."""
        return list(self._core.notices)

    @property
    def pose(self) -> NDArray[np.float64]:
        """Camera to world, (4, 4), glTF's axes: x right, y up, and it looks along -z."""
        return np.asarray(self._core.pose)

    @property
    def intrinsics(self) -> NDArray[np.float64] | None:
        """Matrix (3, 3) from a direction in OpenCV's axes to pixels of this picture, a pixel's middle at 0.5.

        By rays near the axis, at the focus that is set: without distortion, which a traced lens may have. None for an
        orthographic camera.
        """
        focal = self._core.focal_px
        if focal is None:
            return None
        x, y, width, height = self._core.frame
        return np.array([[focal[0], 0, width / 2 - x], [0, focal[1], height / 2 - y], [0, 0, 1]])

    @property
    def focus_m(self) -> float | None:
        """Distance of the sharp plane from the entrance pupil; None for a pinhole."""
        return float(self._core.focus_m) if self._core.focus_m > 0 else None

    def display(self) -> NDArray[np.float32]:
        """R, G, B and alpha as a display shows them, from 0 to 1: (height, width, 4). For matplotlib's imshow."""
        return np.clip(self._core.shown(), 0, 1)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes .exr, .png or .jpg, byte for byte as the command line does. Raises OutputError."""
        self._core.save(os.fsencode(path_text("path", path)))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return self.pixels.astype(dtype or np.float32, copy=bool(copy))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of pixels."""
        return self.pixels.shape

    def __repr__(self) -> str:
        height, width, _ = self.shape
        others = [name for name in self._places if name != "pixels"]
        return f"<Image {width}x{height}{', ' if others else ''}{', '.join(others)}; {self.metadata['petzval:samples']}>"


class _Request:
    """Fields of a render: what is given to it goes before the camera's, and these before the scene's."""

    def __init__(self, scene: SceneBase, camera: CameraBase | None, values: Mapping[str, Any]) -> None:
        if not isinstance(scene, SceneBase):
            raise FieldError(f"scene: takes a Scene, not {type(scene).__name__}", "scene")
        if camera is not None and not isinstance(camera, CameraBase):
            raise FieldError(f"camera: takes a Camera, not {type(camera).__name__}", "camera")
        parts = [scene._fields, *([camera._fields] if camera else []), Fields(_with_lens(values))]
        self.parts = parts  # whose files must last
        self.values = {keyword: value for part in parts for keyword, value in part.values.items()}
        self.texts: Texts = {keyword: texts for part in parts for keyword, texts in part.texts.items()}
        self.texts["file"] = [scene.path]

    def run(self, work: Callable[[list[tuple[str, bytes]]], Any]) -> Any:
        """What work() returns for the keywords. Errors name the field at fault."""
        try:
            return work(encoded(self.texts))
        except Error as error:
            raise naming_field(error, self.texts)


def render_fields(scene: SceneBase, camera: CameraBase | None, progress: OnProgress | None,
                  values: Mapping[str, Any]) -> Image:
    """Renders; _fields.render() says how."""
    if progress is not None and not callable(progress):
        raise FieldError(f"progress: takes a function, not {type(progress).__name__}", "progress")
    request = _Request(scene, camera, values)
    begun_s = time.monotonic()

    def tell(phase: str, done: int, total: int, noise: float) -> None:
        assert progress is not None
        progress(Progress(phase, done, total, noise, time.monotonic() - begun_s))

    return Image(request.run(lambda keywords: scene.session().render(keywords, tell if progress else None)))


def plan_fields(scene: SceneBase, camera: CameraBase | None, values: Mapping[str, Any]) -> dict[str, Any]:
    """Plans; _fields.plan() says how."""
    request = _Request(scene, camera, values)
    found, planned = request.run(lambda keywords: _core.plan(keywords, scene.threads))
    out: dict[str, Any] = json.loads(found)
    texts: Texts = {}
    for keyword, text in planned:
        texts.setdefault(keyword, []).append(os.fsdecode(text))
    out["fields"] = {
        keyword: request.values[keyword] if several == request.texts.get(keyword) else
        True if FIELDS[keyword]["kind"] == "SWITCH" else several if len(several) > 1 else several[0]
        for keyword, several in texts.items() if keyword != "file"}
    return out


def chart_fields(scene: SceneBase, camera: CameraBase | None, axes: Sequence[str], budget: float | str, seeds: int,
                 folder: str | os.PathLike[str] | None, values: Mapping[str, Any]) -> dict[str, Any]:
    """Measures; _fields.chart() says how."""
    seeds = whole("seeds", seeds, _core.LEAST_SEEDS, _core.MOST_SEEDS)
    request = _Request(scene, camera, {**values, "size": values.get("size") or (192, 108)})
    words = [axes] if isinstance(axes, str) else [str(axis) for axis in axes]
    with tempfile.TemporaryDirectory(prefix="petzval-") as own:
        there = path_text("folder", folder) if folder else str(Path(own) / "chart")
        request.run(lambda keywords: _core.chart(keywords, scene.threads, os.fsencode(there), words, str(budget), seeds))
        points: dict[str, Any] = json.loads((Path(there) / "points.json").read_text())
        return points
