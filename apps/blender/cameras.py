# SPDX-License-Identifier: Apache-2.0
"""Cameras, and the part of the frame that a render shows."""
import math

from mathutils import Matrix

from .glb import extras, unscaled


def is_wide(camera, width, height):
    """Whether the sensor fits the picture's width."""
    return camera.sensor_fit == "HORIZONTAL" or (camera.sensor_fit == "AUTO" and width >= height)


def half_height(camera, width, height):
    """Tangent of half the vertical angle of view."""
    side = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
    return side / (2 * camera.lens) * (height / width if is_wide(camera, width, height) else 1)


def frame_words(scene, with_sensor=False):
    """Words of the command line for a scene's picture. With a lens shift it is a part of a larger frame about the axis; a
    render region is a part of it too."""
    render, camera = scene.render, scene.camera and scene.camera.data
    width, height = (max(1, side * render.resolution_percentage // 100) for side in (render.resolution_x, render.resolution_y))
    width = max(1, round(width * render.pixel_aspect_x / render.pixel_aspect_y))  # as it is shown: Petzval's pixels are square
    right = up = 0  # in halves of a pixel
    is_perspective = camera and camera.type == "PERSP"
    if is_perspective:
        side = width if is_wide(camera, width, height) else height
        right, up = round(2 * camera.shift_x * side), round(2 * camera.shift_y * side)
    full = width + abs(right), height + abs(up)
    border = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y)
    x0, x1, y0, y1 = (int(a * b) for a, b in zip(border if render.use_border else (0, 1, 0, 1), (width, width, height, height)))
    crop = (abs(right) + right) // 2 + x0, (abs(up) - up) // 2 + height - y1, x1 - x0, y1 - y0
    words = ["--size", f"{full[0]}x{full[1]}"]
    if crop != (0, 0, *full):
        words += ["--crop", ",".join(map(str, crop))]
    if is_perspective:
        upright = half_height(camera, width, height) * full[1] / height
        tall = 2 * camera.lens * upright
        if right or up:
            words += ["--fov", f"{math.degrees(2 * math.atan(upright)):.7g}"]
        if with_sensor or camera.dof.use_dof and (right or up):
            words += ["--sensor", f"{tall * full[0] / full[1]:.7g}x{tall:.7g}"]
    return words


def add_camera(glb, scene, one, matrix, framed, lost):
    """framed: the command has frame_words()."""
    camera, render = one.data, scene.render
    width, height = render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y
    out = {"name": one.name}
    wide = is_wide(camera, width, height)
    if camera.type == "PERSP":
        upright = half_height(camera, width, height)
        out["type"] = "perspective"
        out["perspective"] = {"yfov": 2 * math.atan(upright), "aspectRatio": width / height,
                              "znear": max(camera.clip_start, 1e-4)}
        if camera.dof.use_dof and camera.dof.aperture_fstop > 0:
            extras(out).update(depth_of_field(camera, one.name, matrix, lost),
                               sensor_mm=[2 * camera.lens * upright * width / height, 2 * camera.lens * upright])
        if (camera.shift_x or camera.shift_y) and not framed:
            lost.append(f"lens shift of camera {one.name} is not in the file: render with {' '.join(frame_words(scene))}")
    elif camera.type == "ORTHO":
        half = camera.ortho_scale / 2  # along the side that fits
        if camera.dof.use_dof:
            lost.append(f"depth of field of orthographic camera {one.name}")
        out["type"] = "orthographic"
        out["orthographic"] = {"xmag": half if wide else half * width / height,
                               "ymag": half * height / width if wide else half, "znear": 1e-3, "zfar": 1e4}
    else:
        lost.append(f"panoramic camera {one.name}")
        return
    place = unscaled(matrix)
    if any((a.xyz.normalized() - b.xyz).length > 1e-3 for a, b in zip(matrix.col[:3], place.col)):
        lost.append(f"mirror or shear of camera {one.name}")
    if camera.type == "ORTHO":
        place @= Matrix.Translation((2 * half * camera.shift_x, 2 * half * camera.shift_y, 0))
    glb.place({"name": one.name, "camera": glb.add("cameras", out)}, place)


def depth_of_field(camera, name, matrix, lost):
    """Extras of a camera: f-number, focus, iris."""
    dof, own = camera.dof, {"fstop": camera.dof.aperture_fstop}
    focus = dof.focus_distance
    if dof.focus_object:
        focus = -(unscaled(matrix).inverted() @ dof.focus_object.matrix_world.translation).z
    if focus > 0:
        own["focus_m"] = focus
    else:
        lost.append(f"the focus of camera {name}, which lies behind it")
    if dof.aperture_blades >= 3:
        own["aperture"] = f"polygon:{dof.aperture_blades},{math.degrees(dof.aperture_rotation):g}"
    if abs(dof.aperture_ratio - 1) > 1e-3:
        lost.append(f"aperture ratio of camera {name}")
    return own
