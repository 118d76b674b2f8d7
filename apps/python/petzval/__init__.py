# SPDX-License-Identifier: Apache-2.0
"""Petzval: photographs glTF scenes through real lenses.

    import petzval
    scene = petzval.Scene("room.glb")
    camera = petzval.Camera(lens="takumar-50mm-f1.2", focus=2)
    image = petzval.render(scene, camera, samples=64, size=(960, 540))
    image.save("room.exr")
"""
from ._arrays import Light, Material, Mesh
from ._errors import Error, FieldError, InputError, OutOfMemory, OutputError
from ._fields import Camera, Scene, chart, plan, render
from ._keywords import Spectrum
from ._lens import (LINE_C_NM, LINE_D_NM, LINE_F_NM, MISSED, PASSED, TOTALLY_REFLECTED, VIGNETTED, Distortion, Lens,
                    Rays, Spot, lens_names)
from ._render import Image, Progress

__all__ = ["Camera", "Distortion", "Error", "FieldError", "Image", "InputError", "LINE_C_NM", "LINE_D_NM", "LINE_F_NM",
           "Lens", "Light", "MISSED", "Material", "Mesh", "OutOfMemory", "OutputError", "PASSED", "Progress", "Rays",
           "Scene", "Spectrum", "Spot", "TOTALLY_REFLECTED", "VIGNETTED", "chart", "lens_names", "plan", "render"]
