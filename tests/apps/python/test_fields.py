# SPDX-License-Identifier: Apache-2.0
"""Every keyword gives the bytes that its option gives."""
import numpy as np
import pytest

import petzval
from conftest import ROOT, run_program
from petzval import _core

CIE = str(ROOT / "assets/spectra/cie1931.csv")
THIN = {"focal_length": 50, "fstop": 2}
GLASS = {"lens": "takumar-50mm-f1.2"}
WAVES = {"spectral": "wavelengths"}
MOVING = {"at": 0.5, "shutter": "0.1s"}
PHOTOGRAPHIC = {"exposure_mode": "photographic", **THIN}
POSE = np.array([[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 3], [0, 0, 0, 1.0]])

# By keyword: its value in Python, its words on a command line, and what must be asked with it.
VALUES = {
    "samples": (range(2, 6), ["--spp", "2:6"], {}),
    "noise": (0.2, ["--noise", "20%"], {"samples": 32}),
    "time_limit": ("1h", ["--time-limit", "1h"], {"samples": 2}),
    "seed": (7, ["--seed", "7"], {}),
    "size": ((20, 10), ["--size", "20x10"], {}),
    "crop": ((1, 2, 3, 4), ["--crop", "1,2,3,4"], {}),
    "tolerance": ("5%", ["--tolerance", "5%"], {}),
    "max_memory": ("1GB", ["--max-memory", "1GB"], {}),
    "confine": (True, ["--confine"], {}),
    "variant": ("red", ["--variant", "red"], {}),
    "scene_name": (1, ["--scene", "1"], {}),
    "point_line_radius": (0.002, ["--method", "point-line-radius=2mm"], {}),
    "at": (0.25, ["--at", "0.25s"], {}),
    "fps": (30, ["--fps", "30"], {"at": "frame:12"}),
    "animation": (["turn"], ["--animation", "turn"], {"at": 0.5}),
    "loop": (True, ["--loop"], {"at": 1.5}),
    "max_depth": (3, ["--method", "max-depth=3"], {}),
    "max_clear_depth": (7, ["--method", "max-clear-depth=7"], {}),
    "filter": ("box", ["--method", "filter=box"], {}),
    "filter_radius": (0.7, ["--method", "filter-radius=0.7"], {}),
    "sampler": ("sobol", ["--method", "sampler=sobol"], {}),
    "light_choice": ("power", ["--method", "light-choice=power"], {}),
    "targets": ("off", ["--method", "targets=off"], {}),
    "clamp": (1000.0, ["--method", "clamp=1000"], {}),
    "traversal": ("fast", ["--method", "traversal=fast"], {}),
    "env": ("studio", ["--env", "studio"], {}),
    "env_rotate": (np.float32(30), ["--env-rotate", "30"], {"env": "studio"}),
    "env_strength": (2, ["--method", "env-strength=2"], {"env": "studio"}),
    "background": ((0, 0.3, 0.1), ["--background", "0,0.3,0.1"], {}),
    "transparent": (True, ["--transparent"], {}),
    "spectral": ("wavelengths", ["--spectral", "wavelengths"], {}),
    "bins": ((400, 700, 50), ["--bins", "400:700:50"], {"samples": 8}),
    "illuminant": ("a", ["--illuminant", "a"], WAVES),
    "response": (CIE, ["--response", CIE], WAVES),
    "white_balance": ("illuminant", ["--method", "white-balance=illuminant"], {**WAVES, "illuminant": "a"}),
    "camera_name": ("right", ["--camera", "right"], {}),
    "look_at": ([0, 1, 3, 0, 0, -1], ["--look-at", "0,1,3,0,0,-1"], {}),
    "pose": (POSE, ["--pose", "0,1,0,0,-1,0,0,0,0,0,1,3"], {}),
    "orbit": (90, ["--orbit", "90"], {}),
    "orbit_about": ((1, 2, 3), ["--method", "orbit-about=1,2,3"], {"orbit": 30}),
    "fov": (41, ["--fov", "41"], {}),
    "sensor": ((30, 20), ["--sensor", "30x20"], THIN),
    "focus": (2.5, ["--focus", "2.5m"], THIN),
    "fstop": (4, ["--fstop", "f/4"], {"focal_length": 50}),
    "lens_radius": (0.01, ["--method", "lens-radius=1cm"], {}),
    "focal_length": (40, ["--focal-length", "40"], {"fstop": 2}),
    "film_distance": (51, ["--method", "film-distance=51mm"], THIN),
    "lens": (petzval.Lens("takumar-50mm-f1.2"), ["--lens", "takumar-50mm-f1.2"], {}),
    "glasses": (["own.agf"], ["--glasses", "own.agf"], GLASS),
    "focus_by": ("traced", ["--method", "focus-by=traced"], GLASS),
    "fit": ("fov", ["--method", "fit=fov"], GLASS),
    "aperture": ("star:5", ["--aperture", "star:5"], THIN),
    "aperture_scale": ("inscribed", ["--method", "aperture-scale=inscribed"], {**THIN, "aperture": "star:5"}),
    "iris_sampling": ("rejection", ["--method", "iris-sampling=rejection"], THIN),
    "dispersion": ("hero", ["--method", "dispersion=hero"], {"lens": "singlet:N-BK7", **THIN}),
    "coating": ("mgf2", ["--method", "coating=mgf2"], GLASS),
    "ghosts": ("off", ["--ghosts", "off"], GLASS),
    "diffraction": ("auto", ["--diffraction", "auto"], THIN),
    "lens_precision": ("double", ["--method", "lens-precision=double"], GLASS),
    "exposure_mode": ("photographic", ["--exposure-mode", "photographic"], THIN),
    "natural_vignetting": ("off", ["--method", "natural-vignetting=off"], PHOTOGRAPHIC),
    "iso": (3200, ["--iso", "3200"], PHOTOGRAPHIC),
    "shutter": (0.1, ["--shutter", "1/10s"], {"at": 0.5}),
    "shutter_curve": ("trapezoid", ["--method", "shutter-curve=trapezoid"], MOVING),
    "exposure": (1, ["--exposure", "1"], {}),
    "view": ("raw", ["--view", "raw"], {}),
    "ocio": (str(ROOT / "assets/color/config.ocio"), ["--ocio", str(ROOT / "assets/color/config.ocio")], {}),
    "layers": (["depth", "normal"], ["--aov", "depth,normal"], {}),
    "denoise": (True, ["--denoise"], {}),
}


def words_of(keyword, text):
    """Words of the command line for a keyword with this text."""
    option, *_ = VALUES[keyword][1]
    return [option, f"{keyword.replace('_', '-')}={text}"] if option == "--method" else [option, str(text)]


def test_table_has_all_fields():
    assert sorted(VALUES) == sorted(field["keyword"] for field in _core.fields())


@pytest.mark.parametrize("keyword", VALUES)
def test_same_bytes_as_the_command_line(keyword, everything, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.agf").write_text("NM X1 2 000000 1.5 50 0\nCD 1.25 0 0 0 0 0\nLD 0.3 2.5\n")
    value, words, also = VALUES[keyword]
    also = {"samples": 2, "size": "24x16", **also}
    also.pop(keyword, None)
    scene, camera, rest = {}, {}, {}
    owners = {field["keyword"]: field["owner"] for field in _core.fields()}
    for key, given in {keyword: value, **also}.items():
        {"scene": scene, "camera": camera, "render": rest}[owners[key]][key] = given
    image = petzval.render(petzval.Scene(everything, **scene), petzval.Camera(**camera), **rest)
    names = ["a.exr", "a.png", "a.jpg"]
    for name in names:
        image.save(tmp_path / name)
    outputs = [word for name in names for word in ("-o", tmp_path / f"program-{name}")]
    run_program("render", everything, "--quiet", *words,
                *(word for one in also.items() for word in words_of(*one)), *outputs)
    for name in names:
        assert (tmp_path / name).read_bytes() == (tmp_path / f"program-{name}").read_bytes(), name
