# SPDX-License-Identifier: Apache-2.0
"""The optics bench, against the command line's and against closed forms."""
import math
import pickle
import re

import numpy as np
import pytest

import petzval
from conftest import run_program

NAME = "double-gauss-100mm-f2"


def test_spots_are_those_of_the_command_line(tmp_path):
    lens = petzval.Lens(NAME)
    said = run_program("lens", "spot", NAME, "--field", "10", "-o", tmp_path / "spot.svg")
    lines = dict(zip("FdC", (petzval.LINE_F_NM, petzval.LINE_D_NM, petzval.LINE_C_NM)))
    for line, nm in lines.items():
        spot = lens.spot(10, nm, side=300)
        row = re.search(rf"10 +{line} +(\S+) +(\S+) +(\S+)", said)
        assert math.isclose(spot.centroid_mm[1], float(row[2]), abs_tol=1e-6)
        assert math.isclose(1000 * spot.rms_mm, float(row[3]), abs_tol=1e-4)
        assert np.allclose(spot.points_mm.mean(axis=0), spot.centroid_mm)


def test_rays_are_refracted_as_snell_says(tmp_path):
    (tmp_path / "plane.json").write_text(
        '{"name": "plane", "surfaces": [{"radius": null, "thickness": 10, "semi_diameter": 50, "medium": null, "stop": true},'
        '{"radius": null, "thickness": 10, "semi_diameter": 50, "medium": {"glass": "schott:N-BK7"}},'
        '{"radius": null, "thickness": 10, "semi_diameter": 50, "medium": null}]}')
    lens = petzval.Lens(tmp_path / "plane.json")
    angle = 0.5
    rays = lens.trace([[0, 0, -5]], [[0, math.sin(angle), math.cos(angle)]])
    index = 1.51680  # N-BK7 at line d: Schott 2023
    inside = math.asin(math.sin(angle) / index)
    assert math.isclose(rays.points_mm[0, 1], 15 * math.tan(angle) + 10 * math.tan(inside), rel_tol=1e-5)
    assert np.allclose(rays.directions[0], [0, math.sin(angle), math.cos(angle)])
    assert math.isclose(rays.paths_mm[0], 15 / math.cos(angle) + index * 10 / math.cos(inside), rel_tol=1e-5)
    back = lens.trace(rays.points_mm, -rays.directions, towards="scene")
    assert np.allclose(back.directions, -np.array([[0, math.sin(angle), math.cos(angle)]]))


def test_many_rays_with_their_own_wavelengths_and_ends():
    lens, random = petzval.Lens(NAME), np.random.default_rng(3)
    count = 1001
    origins = np.column_stack([random.uniform(-40, 40, (count, 2)), np.full(count, -20)])
    directions = np.column_stack([random.normal(0, 0.2, (count, 2)), np.ones(count)])
    nm = random.uniform(400, 700, count)
    rays = lens.trace(origins, directions, nm)
    assert set(rays.status) >= {petzval.PASSED, petzval.VIGNETTED}
    passed = rays.status == petzval.PASSED
    assert np.isfinite(rays.points_mm[passed]).all() and np.isnan(rays.points_mm[~passed]).all()
    assert (rays.end_surfaces[passed] == -1).all() and (rays.end_surfaces[~passed] >= 0).all()
    some = np.flatnonzero(passed)[:9]
    alone = [lens.trace(origins[i:i + 1], directions[i:i + 1], nm[i:i + 1]).points_mm[0] for i in some]
    assert np.array_equal(alone, rays.points_mm[some])
    assert lens.trace(np.zeros((0, 3)), np.zeros((0, 3))).status.shape == (0,)
    lost = lens.trace([[np.nan, 0, 0]], [[0, 0, 0]])
    assert lost.status[0] == petzval.MISSED


def test_focus_moves_the_film_by_newtons_equation():
    lens = petzval.Lens(NAME)
    near = lens.focused(2.0)
    f, shift = lens.facts["focal_length_mm"], near.film_mm - lens.focused(math.inf).film_mm
    assert 0.9 < shift * (2000 - f) / f**2 < 1.1
    assert near.spot(0).rms_mm < 2 * lens.spot(0).rms_mm
    with pytest.raises(petzval.FieldError) as error:
        lens.focused(0.01)
    assert error.value.field == "distance_m"
    best = lens.best_film_shift_mm()
    before = lens.spot(0).rms_mm
    lens.film_mm += best
    assert lens.spot(0).rms_mm < before


def test_mtf_distortion_and_vignetting():
    lens = petzval.Lens(NAME)
    tangential, sagittal = lens.mtf([0, 10, 40], 7)
    assert tangential[0] == sagittal[0] == 1 and tangential[2] < tangential[1] < 1
    spread = lens.distortion([5, 10])
    assert np.allclose(spread.ideal_heights_mm, lens.facts["focal_length_mm"] * np.tan(np.radians([5, 10])))
    light = lens.vignetting([0, 10, 20])
    assert light[0] == 1 and 1 > light[1] > light[2] > 0


def test_facts_surfaces_and_names():
    lens = petzval.Lens(NAME)
    assert NAME in petzval.lens_names() and "100 mm" in repr(lens) and lens.name == NAME
    assert sum(surface["stop"] for surface in lens.surfaces) == 1
    assert pickle.loads(pickle.dumps(lens.focused(1))).film_mm == lens.focused(1).film_mm


def test_wrong_input_is_named():
    lens = petzval.Lens(NAME)
    one = [[0, 0, -1]]
    cases = [("origins_mm", lambda: lens.trace([0, 0, 1], one)), ("directions", lambda: lens.trace(one, [[0, 1]])),
             ("directions", lambda: lens.trace(one, one * 2)), ("wavelengths_nm", lambda: lens.trace(one, one, [1, 2])),
             ("wavelengths_nm", lambda: lens.trace(one, one, math.nan)), ("origins_mm", lambda: lens.trace("a", one)),
             ("towards", lambda: lens.trace(one, one, towards="up")), ("field_deg", lambda: lens.spot(95)),
             ("field_deg", lambda: lens.spot(math.nan)), ("field_deg", lambda: lens.spot(80)),
             ("side", lambda: lens.spot(0, side=0)), ("wavelength_nm", lambda: lens.spot(0, -1)),
             ("distance_m", lambda: lens.focused("near")), ("distance_m", lambda: lens.focused(-1)),
             ("fields_deg", lambda: lens.distortion([0])), ("by", lambda: lens.focused(1, "eye")),
             ("film_mm", lambda: setattr(lens, "film_mm", math.inf))]
    for field, call in cases:
        with pytest.raises(petzval.FieldError) as error:
            call()
        assert error.value.field == field
    with pytest.raises(petzval.InputError, match="did you mean|takumar"):
        petzval.Lens("takumar")
