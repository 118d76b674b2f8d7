# SPDX-License-Identifier: Apache-2.0
"""The optics bench: rays through a lens prescription, and what they say of it."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core  # type: ignore[attr-defined]
from ._errors import FieldError
from ._keywords import numbers, path_text, whole

LINE_F_NM: float = _core.LINE_F_NM
LINE_D_NM: float = _core.LINE_D_NM
LINE_C_NM: float = _core.LINE_C_NM
PASSED: int = _core.PASSED
VIGNETTED: int = _core.VIGNETTED
TOTALLY_REFLECTED: int = _core.TOTALLY_REFLECTED
MISSED: int = _core.MISSED


class Rays(NamedTuple):
    """Rays that were traced; NaN where one did not pass."""

    points_mm: NDArray[np.float64]
    """On the last surface: (N, 3); z = 0 at the first vertex, +z towards the film."""
    directions: NDArray[np.float64]
    """Of unit length: (N, 3)."""
    paths_mm: NDArray[np.float64]
    """Optical path from the origin: (N,)."""
    status: NDArray[np.int32]
    """PASSED, VIGNETTED, TOTALLY_REFLECTED or MISSED: (N,)."""
    end_surfaces: NDArray[np.int32]
    """Surface that stopped the ray, from 0; -1 of one that passed: (N,)."""

    def at_plane(self, z_mm: float) -> NDArray[np.float64]:
        """Points (N, 2) at which the rays meet a plane across the axis."""
        steps = (z_mm - self.points_mm[:, 2]) / self.directions[:, 2]
        return self.points_mm[:, :2] + steps[:, None] * self.directions[:, :2]


class Spot(NamedTuple):
    """Image of a point: rays that fill the entrance pupil evenly."""

    points_mm: NDArray[np.float64]
    """On the film: (N, 2)."""
    pupil_mm: NDArray[np.float64]
    """In the entrance pupil, sagittal and tangential: (N, 2)."""
    centroid_mm: tuple[float, float]
    rms_mm: float
    """Root of the mean square distance from the centroid."""
    best_shift_mm: float
    """Shift of the film to where the spot is smallest."""


class Distortion(NamedTuple):
    """Heights on the film of rays through the middle of the stop, line d: (fields,); NaN where one is lost."""

    heights_mm: NDArray[np.float64]
    ideal_heights_mm: NDArray[np.float64]

    @property
    def relative(self) -> NDArray[np.float64]:
        """Distortion: 0.01 is 1 % too high."""
        return self.heights_mm / self.ideal_heights_mm - 1


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise FieldError(f"{name}: takes a number, not {value!r}", name) from None


class Lens:
    """A lens that ships, by its name (lens_names()), or a file: .json, .dat (pbrt) or .zmx.

    glasses: catalogues, .agf, that go before those that ship. A new lens stands as filed, its film where a distant
    point is sharp by the file; focused() moves it. Lengths are in mm, angles in degrees; fields are on the side of +y.
    """

    def __init__(self, lens: str | os.PathLike[str], *, glasses: Sequence[str | os.PathLike[str]] = ()) -> None:
        self.source = path_text("lens", lens)
        several = [glasses] if isinstance(glasses, (str, os.PathLike)) else glasses
        self._glasses = [path_text("glasses", one) for one in several]
        self._focus: tuple[float, str] | None = None
        self._core = _core.Lens(os.fsencode(self.source), [os.fsencode(one) for one in self._glasses])
        self._filed_mm = self.film_mm

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_core": self.film_mm}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["source"], glasses=state["_glasses"])  # type: ignore[misc]
        if focus := state["_focus"]:
            self.__dict__.update(self.focused(*focus).__dict__)
        self.film_mm = state["_core"]

    def keywords(self) -> dict[str, Any]:
        """Keywords of a camera that has this lens. Raises FieldError where its film was moved."""
        if self.film_mm != self._filed_mm:
            raise FieldError("lens: its film was moved by hand; a camera takes a Lens as filed, or focused()", "lens")
        out: dict[str, Any] = {"lens": self.source, "glasses": self._glasses or None}
        if self._focus:
            distance_m, by = self._focus
            out.update(focus="infinity" if distance_m == np.inf else distance_m, focus_by=by)
        return out

    @property
    def facts(self) -> dict[str, Any]:
        """What its file states, and first-order data at line d."""
        return dict(self._core.facts(LINE_D_NM))

    @property
    def name(self) -> str:
        """Its name."""
        return str(self.facts["name"])

    @property
    def surfaces(self) -> list[dict[str, Any]]:
        """Its surfaces, from the scene's side."""
        return list(self._core.surfaces())

    @property
    def film_mm(self) -> float:
        """Place of the film, from the first vertex. May be set."""
        return float(self._core.film_mm)

    @film_mm.setter
    def film_mm(self, film_mm: float) -> None:
        film_mm = _number("film_mm", film_mm)
        if not np.isfinite(film_mm):
            raise FieldError(f"film_mm: {film_mm} is not a place", "film_mm")
        self._core.film_mm = film_mm

    def focal_length_mm(self, wavelength_nm: float = LINE_D_NM) -> float:
        """Paraxial focal length at a wavelength."""
        return float(self._core.facts(_wavelength(wavelength_nm))["focal_length_mm"])

    def focused(self, distance_m: float, by: str = "paraxial") -> Lens:
        """The lens in focus at a distance from its entrance pupil, which may be infinite. by: "paraxial", or "traced"
        for the smallest spot on the axis. Fields are then those of points in that plane."""
        distance_m = _number("distance_m", distance_m)
        if not distance_m > 0:
            raise FieldError(f"distance_m: {distance_m} is not above 0", "distance_m")
        if by not in ("paraxial", "traced"):
            raise FieldError(f'by: "{by}" is neither "paraxial" nor "traced"', "by")
        out = object.__new__(Lens)
        out.__dict__.update(self.__dict__, _focus=(distance_m, by))
        out._core = self._core.focused(1e3 * distance_m, by == "traced")
        out._filed_mm = out.film_mm
        return out

    def best_film_shift_mm(self) -> float:
        """Shift of the film to the smallest spot on the axis, of F, d and C together."""
        return float(self._core.best_film_shift())

    def trace(self, origins_mm: ArrayLike, directions: ArrayLike, wavelengths_nm: ArrayLike = LINE_D_NM, *,
              towards: str = "film", clip: bool = True) -> Rays:
        """Traces rays through all surfaces in double precision.

        origins_mm, directions: (N, 3), z = 0 at the first vertex and +z towards the film; directions of any length.
        wavelengths_nm: (N,), or one for all. towards: "film" or "scene". clip: rims stop rays.
        """
        if towards not in ("film", "scene"):
            raise FieldError(f'towards: "{towards}" is neither "film" nor "scene"', "towards")
        waves = numbers("wavelengths_nm", np.atleast_1d(wavelengths_nm), (None,))
        if not (waves > 0).all():
            raise FieldError("wavelengths_nm: hold one that is not above 0", "wavelengths_nm")
        return Rays(*self._core.trace(_array("origins_mm", origins_mm), _array("directions", directions), waves,
                                      towards == "scene", bool(clip)))

    def spot(self, field_deg: float = 0, wavelength_nm: float = LINE_D_NM, side: int = 64) -> Spot:
        """Image of a point at an angle from the axis; side x side rays are aimed at the entrance pupil."""
        points, pupil, centroid, rms, shift = self._core.spot(_number("field_deg", field_deg),
                                                              _wavelength(wavelength_nm), whole("side", side, 1, 5000), False)
        return Spot(points, pupil, (centroid[0], centroid[1]), rms, shift)

    def mtf(self, cycles_per_mm: ArrayLike, field_deg: float = 0,
            wavelengths_nm: Sequence[float] = (LINE_F_NM, LINE_D_NM, LINE_C_NM), side: int = 100,
            ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Geometric contrast (without diffraction), tangential and sagittal, at each frequency."""
        cycles = numbers("cycles_per_mm", np.atleast_1d(cycles_per_mm), (None,))
        tangential, sagittal = self._core.mtf(cycles.tolist(), _number("field_deg", field_deg),
                                              [_wavelength(nm) for nm in wavelengths_nm], whole("side", side, 1, 5000))
        return np.array(tangential), np.array(sagittal)

    def distortion(self, fields_deg: ArrayLike) -> Distortion:
        """Heights on the film at these angles, above 0, against f tan(field)."""
        real, ideal = self._core.heights(numbers("fields_deg", np.atleast_1d(fields_deg), (None,)).tolist())
        return Distortion(np.array(real), np.array(ideal))

    def vignetting(self, heights_mm: ArrayLike) -> NDArray[np.float64]:
        """Irradiance on the film at these heights over that in its middle, wide open, of an even scene, line d."""
        heights = numbers("heights_mm", np.atleast_1d(heights_mm), (None,))
        light = np.array(self._core.irradiance([0.0, *heights.tolist()]))
        return light[1:] / light[0]

    def __repr__(self) -> str:
        facts = self.facts
        return f"<Lens {facts['name']}: {facts['focal_length_mm']:.4g} mm, f/{facts['fnumber']:.3g}>"


def _array(name: str, values: Any) -> NDArray[np.float64]:
    """Numbers that may be NaN: such rays are lost."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise FieldError(f"{name}: takes numbers, not {type(values).__name__}", name) from None


def _wavelength(nm: Any) -> float:
    nm = _number("wavelength_nm", nm)
    if not (np.isfinite(nm) and nm > 0):
        raise FieldError(f"wavelength_nm: {nm} is not above 0", "wavelength_nm")
    return nm


def lens_names() -> list[str]:
    """Names of the lenses that ship."""
    return list(_core.lens_names())
