# SPDX-License-Identifier: Apache-2.0
"""Renders of Petzval's program beside Blender."""
import ctypes
import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import tempfile
import threading

import bpy

from . import cameras
from .scene import export

PR_SET_PDEATHSIG = 1  # prctl(2)


class Failed(Exception):
    """What the user is told."""


class Now:
    """The one render that runs, a generator of render(), and the folder of the picture that is shown."""
    work, folder = None, ""


def find_program():
    """Path of the program: of the preferences, beside the add-on, or on the path; None where there is none."""
    addon = bpy.context.preferences.addons.get(__package__)
    named = addon and addon.preferences and bpy.path.abspath(addon.preferences.program)
    here = os.path.dirname(os.path.abspath(__file__))
    return shutil.which(named or "petzval", path=os.pathsep.join([here, os.path.join(here, "bin"), os.environ.get("PATH", "")]))


def command_of(scene, glb="scene.glb", picture="picture.exr", preview=None):
    """Words of the command that renders an exported scene."""
    own = scene.petzval
    lens = "" if own.lens == "camera" else own.lens
    words = [find_program(), "render", glb, *cameras.frame_words(scene, with_sensor=lens)]
    words += ["--noise", f"{own.noise:g}%"] if own.stop_at == "noise" else ["--spp", str(own.samples)]
    if lens and own.keep_framing and scene.camera:
        words += ["--method", "fit=fov"]
    if lens and own.dispersion != "auto":
        words += ["--method", f"dispersion={own.dispersion}"]
    words += ["--denoise"] * own.denoise + ["--transparent"] * scene.render.film_transparent
    for option, value in (("--lens", lens), ("--fstop", own.fstop and f"{own.fstop:g}"), ("--aperture", own.aperture),
                          ("--aov", own.layers), ("--preview", preview), ("-o", picture)):
        words += [option, value] if value else []
    return words


def shown(words):
    """The words as a shell takes them, the program by its name."""
    return shlex.join([os.path.basename(words[0] or "petzval"), *words[1:]])


def render(scene, animation):
    """Renders the frame, or all. Gives phase and fraction each time it is asked, until it ends; close() stops it. What is
    not finished is removed."""
    before, folder = scene.frame_current, None
    try:
        if not find_program():
            raise Failed("Petzval's program is not found; install it, or name it in the add-on's preferences")
        if animation and scene.render.filepath.startswith("//") and not bpy.data.filepath:
            raise Failed("save the file first, or name a folder for the frames in the output properties")
        folder = tempfile.mkdtemp(prefix="petzval-", dir=bpy.app.tempdir)  # which Blender removes when it ends
        glb, preview, picture = (os.path.join(folder, name) for name in ("scene.glb", "preview.png", "Petzval.exr"))
        for frame in range(scene.frame_start, scene.frame_end + 1, scene.frame_step) if animation else [before]:
            if animation:
                scene.frame_set(frame)
                preview, picture = None, os.path.splitext(scene.render.frame_path(frame=frame))[0] + ".exr"
                os.makedirs(os.path.dirname(picture) or ".", exist_ok=True)
            scene.petzval.lost = "\n".join(export(glb, scene, framed=True))
            yield from follow(command_of(scene, glb, picture, preview), picture, preview)
        scene.petzval.status = "done"
        if not animation:
            _load(picture)
            shutil.rmtree(Now.folder, ignore_errors=True)
            Now.folder, folder = folder, None
    except BaseException as error:
        scene.petzval.status = "stopped" if isinstance(error, GeneratorExit) else str(error)
        raise
    finally:
        if animation:
            scene.frame_set(before)
        shutil.rmtree(folder or "", ignore_errors=True)
        Now.work = None


def _end_with_blender():
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def follow(words, picture, preview=None):
    """Runs the program: gives phase and fraction each time it is asked, until it has ended. Raises Failed where there is no
    picture. close() ends it; what it has goes too."""
    said, errors, seen = {"phase": "loading", "fraction": 0.0}, [], None

    def listen():
        for line in process.stderr:
            try:
                new = json.loads(line)
            except ValueError:
                new = {"error": line.strip()}
            errors.extend([new["error"]] if new.get("error") else [])
            said.update((key, value) for key, value in new.items() if value is not None)

    environment = {key: value for key, value in os.environ.items() if key not in ("OCIO", "LD_LIBRARY_PATH")}
    with subprocess.Popen([*words, "--progress", "json"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          errors="replace", env=environment, preexec_fn=_end_with_blender) as process:
        listener = threading.Thread(target=listen, daemon=True)
        listener.start()
        try:
            while process.poll() is None:
                yield said["phase"], said["fraction"]
                changed = os.stat(preview).st_mtime_ns if preview and os.path.exists(preview) else seen
                if changed != seen:
                    seen = changed
                    _load(preview)
        except GeneratorExit:
            process.terminate()
            try:
                process.wait(5)
            except subprocess.TimeoutExpired:
                process.kill()
            picture = pathlib.Path(picture)
            for left in (picture.with_suffix(".partial" + picture.suffix), picture.with_suffix(".state")):
                left.unlink(missing_ok=True)
            raise
        listener.join(5)
    if process.returncode:
        raise Failed("; ".join(errors) or f"Petzval ended with {process.returncode}")


def _load(path):
    """Shows a file as the image "Petzval", in image editors that have no other."""
    image = bpy.data.images.get("Petzval")
    windows = bpy.context.window_manager.windows if bpy.context.window_manager else ()
    spaces = [area.spaces.active for window in windows for area in window.screen.areas if area.type == "IMAGE_EDITOR"]
    spaces = [one for one in spaces if one.image in (None, image) or one.image.type == "RENDER_RESULT"]
    if image:
        bpy.data.images.remove(image)
    image = bpy.data.images.load(path)
    image.name = "Petzval"
    for one in spaces:
        one.image = image
