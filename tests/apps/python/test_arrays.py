# SPDX-License-Identifier: Apache-2.0
"""Scenes from arrays, against what they must look like in closed form."""
import numpy as np
import pytest

import petzval
from conftest import ROOT, run_program

SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
TWO = [[0, 1, 2], [0, 2, 3]]
MATT = {"extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
FRONT = {"look_at": (0, 0, 5, 0, 0, 0), "fov": 20}


def test_white_square_under_an_even_sky_shows_its_albedo():
    material = petzval.Material((0.25, 0.5, 0.75), gltf=MATT)
    scene = petzval.Scene.from_arrays([petzval.Mesh(SQUARE, TWO, material=material)], env=np.full((8, 16, 3), 2.0))
    image = petzval.render(scene, petzval.Camera(**FRONT), samples=64, size=(8, 8), spectral="rgb")
    assert np.allclose(image.rgb[2:-2, 2:-2], [0.5, 1.0, 1.5], rtol=1e-2)


@pytest.mark.parametrize("kind", ["uint8", "float"])
def test_texture_stands_upright_and_keeps_its_colours(kind):
    texture = np.zeros((2, 2, 3))
    texture[0, 0], texture[0, 1], texture[1, 0], texture[1, 1] = [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.2, 0.2, 0.2]
    texture = given = texture.repeat(8, axis=0).repeat(8, axis=1)
    if kind == "uint8":  # 0.2 is 124 of 255 on a display
        given = np.where(texture == 0.2, 124, 255 * texture).astype(np.uint8)
    mesh = petzval.Mesh(SQUARE, TWO, normals=[[0, 0, 1]] * 4, uvs=[[0, 1], [1, 1], [1, 0], [0, 0]],
                        material=petzval.Material(given, gltf=MATT))
    scene = petzval.Scene.from_arrays([mesh], background=(1, 1, 1))
    image = petzval.render(scene, petzval.Camera(look_at=(0, 0, 5, 0, 0, 0), fov=22.6), samples=64, size=(32, 32),
                           spectral="rgb")
    corners = image.rgb[[4, 4, 27, 27], [4, 27, 4, 27]]
    assert np.allclose(corners, texture[[0, 0, 15, 15], [0, 15, 0, 15]], atol=0.02)


def test_light_and_pose_follow_the_inverse_square():
    pose = np.eye(4)
    pose[:3, 3] = [0, 0, 2]
    wall = petzval.Mesh(SQUARE, TWO, material=petzval.Material((0.5, 0.5, 0.5), gltf=MATT))
    scene = petzval.Scene.from_arrays([wall], [petzval.Light("point", 100, pose=pose)], background=(0, 0, 0))
    image = petzval.render(scene, petzval.Camera(**FRONT), samples=64, size=(33, 33), spectral="rgb")
    assert np.allclose(image.rgb[16, 16], 0.5 / np.pi * 100 / 4, rtol=1e-2)
    spot = petzval.Light("spot", 100, pose=pose, gltf={"spot": {"outerConeAngle": 0.1}})
    dark = petzval.render(petzval.Scene.from_arrays([wall], [spot], background=(0, 0, 0)), petzval.Camera(**FRONT),
                          samples=16, size=(33, 33))
    assert dark.rgb[16, 16].max() > 1 and dark.rgb[2, 2].max() == 0


def test_reflectance_and_emission_are_what_they_say():
    grey = petzval.Material(reflectance=petzval.Spectrum([380, 730], [0.3, 0.3]), gltf=MATT)
    lamp = petzval.Material((0, 0, 0), emission_nits=(3, 1, 2))
    lower, upper = np.eye(4), np.eye(4)
    lower[1, 3], upper[1, 3] = -1, 1
    scene = petzval.Scene.from_arrays([petzval.Mesh(SQUARE, TWO, material=grey, pose=lower),
                                       petzval.Mesh(SQUARE, TWO, material=lamp, pose=upper)], background=(1, 1, 1))
    image = petzval.render(scene, petzval.Camera(**FRONT), samples=256, size=(16, 16), spectral="wavelengths")
    assert np.allclose(image.rgb[2:6, 4:-4].mean(axis=(0, 1)), [3, 1, 2], rtol=0.02)
    assert np.allclose(image.rgb[10:14, 4:-4].mean(axis=(0, 1)), 0.3, rtol=0.03)


def test_same_bytes_as_the_command_line_gives_for_its_file(tmp_path):
    mesh = petzval.Mesh(SQUARE[[0, 1, 2, 0, 2, 3]], material=petzval.Material(reflectance="colorchecker:dark_skin"))
    sky = np.random.default_rng(1).uniform(0, 1, (8, 16, 3))
    scene = petzval.Scene.from_arrays([mesh], env=sky)
    image = petzval.render(scene, petzval.Camera(**FRONT), samples=4, size=(24, 16))
    image.save(tmp_path / "a.exr")
    env = scene._fields.texts["env"][0]
    run_program("render", scene.path, "--env", env, "--look-at", "0,0,5,0,0,0", "--fov", 20, "--spp", 4, "--size",
                "24x16", "--quiet", "-o", tmp_path / "b.exr")
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_response_and_illuminant_as_arrays(tmp_path):
    rows = [line.split(",") for line in (ROOT / "assets/spectra/cie1931.csv").read_text().splitlines()
            if line and not line.startswith("#")][1:]
    table = np.array(rows, float)
    mesh = petzval.Mesh(SQUARE, TWO, material=petzval.Material(reflectance="colorchecker:red", gltf=MATT))
    scene = petzval.Scene.from_arrays([mesh], background=(1, 1, 1))
    asked = {"samples": 32, "size": (8, 8), "spectral": "wavelengths"}
    own = petzval.render(scene, petzval.Camera(**FRONT), response=petzval.Spectrum(table[:, 0], table[:, 1:4]), **asked)
    eye = petzval.render(scene, petzval.Camera(**FRONT), **asked)
    assert np.allclose(own.rgb[4, 4], eye.rgb[4, 4], rtol=0.1)
    flat = petzval.render(scene, petzval.Camera(**FRONT), illuminant=petzval.Spectrum([360, 830], [1, 1]), **asked)
    assert not np.allclose(flat.rgb[4, 4], eye.rgb[4, 4], rtol=1e-3)


def test_alpha_is_blended_and_generators_give_what_lists_give():
    half = petzval.Material((0, 0, 0, 0.25), gltf=MATT)
    texture = petzval.Material(np.full((2, 2, 4), 0.25) * [0, 0, 0, 1], gltf=MATT)
    uvs = [[0, 1], [1, 1], [1, 0], [0, 0]]
    for material in (half, texture):
        scene = petzval.Scene.from_arrays((petzval.Mesh(SQUARE, TWO, uvs=uvs, material=one) for one in (material,)),
                                          background=(1, 1, 1))
        image = petzval.render(scene, petzval.Camera(**FRONT), samples=16, size=(9, 9), spectral="rgb")
        assert np.allclose(image.rgb[4, 4], 0.75, atol=0.02)
    colors = [(c, 0, 0) for c in (0.1, 0.3, 0.5, 0.7)]
    scene = petzval.Scene.from_arrays(petzval.Mesh(SQUARE / 2 + [2 * i, 0, 0], TWO, material=petzval.Material(c, gltf=MATT))
                                      for i, c in enumerate(colors))
    image = petzval.render(scene, petzval.Camera(look_at=(3, 0, 20, 3, 0, 0), fov=23), samples=16, size=(32, 32),
                           layers=["albedo"])
    assert np.allclose(image.layers["albedo"][16, 4::8, 0], [0.1, 0.3, 0.5, 0.7], atol=0.02)


def test_wrong_arrays_are_named():
    for field, mesh in {
        "positions": petzval.Mesh(np.zeros((4, 2)), TWO), "triangles": petzval.Mesh(SQUARE, [[0, 1, 4]]),
        "normals": petzval.Mesh(SQUARE, TWO, normals=[[0, 0, 1]]), "uvs": petzval.Mesh(SQUARE, TWO, uvs="ab"),
        "pose": petzval.Mesh(SQUARE, TWO, pose=np.eye(3)),
        "base_color": petzval.Mesh(SQUARE, TWO, material=petzval.Material(np.zeros((4, 4)))),
    }.items():
        with pytest.raises(petzval.FieldError) as error:
            petzval.Scene.from_arrays([mesh])
        assert error.value.field == field
    for field, material in {"roughness": petzval.Material(roughness=np.nan), "emission_nits": petzval.Material(emission_nits=5),
                            "gltf": petzval.Material(gltf={"extras": {"x": np.inf}}),
                            "base_color": petzval.Material(("a", "b", "c"))}.items():
        with pytest.raises(petzval.FieldError) as error:
            petzval.Scene.from_arrays([petzval.Mesh(SQUARE, TWO, material=material)])
        assert error.value.field == field
    with pytest.raises(petzval.FieldError):
        petzval.Scene.from_arrays([], [petzval.Light(intensity=np.inf)])
    for broken in (SQUARE * np.nan, SQUARE[:0], np.zeros((5, 3)), None, "mesh"):
        with pytest.raises(petzval.FieldError) as error:
            petzval.Scene.from_arrays([petzval.Mesh(broken)])
        assert error.value.field == "positions"
    with pytest.raises(petzval.FieldError):
        petzval.Spectrum([400, 500], [1])
