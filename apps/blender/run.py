# SPDX-License-Identifier: Apache-2.0
"""A render of Petzval's program as it runs beside Blender."""
import ctypes
import json
import os
import shlex
import shutil
import signal
import subprocess
import threading

import bpy

PR_SET_PDEATHSIG = 1  # prctl(2)


class Failed(Exception):
    """What the user is told."""


def shown(words):
    """The words as a shell takes them, the program by its name."""
    return shlex.join([os.path.basename(words[0] or "petzval"), *words[1:]])


def _end_with_blender():
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class Render:
    """One run of the program. At most one at a time: running."""

    running = None
    kept = ""  # folder of the picture that is shown

    @classmethod
    def keep(cls, folder):
        """Keeps a folder in place of the one before."""
        shutil.rmtree(cls.kept, ignore_errors=True)
        cls.kept = folder

    def __init__(self, words, picture, preview):
        self.picture, self.preview = picture, preview
        self.phase, self.fraction, self.stop_asked = "loading", 0.0, False
        self._errors, self._seen = [], None
        environment = {key: value for key, value in os.environ.items() if key not in ("OCIO", "LD_LIBRARY_PATH")}
        self._process = subprocess.Popen([*words, "--progress", "json"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                         text=True, errors="replace", env=environment, preexec_fn=_end_with_blender)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        Render.running = self

    def _read(self):
        for line in self._process.stderr:
            try:
                said = json.loads(line)
            except ValueError:
                self._errors.append(line.strip())
                continue
            if said.get("event") == "error":
                self._errors.append(said.get("error", line.strip()))
            self.phase = said.get("phase") or self.phase
            self.fraction = said.get("fraction", self.fraction)

    def has_ended(self):
        return self._process.poll() is not None

    def wait(self, seconds):
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            pass

    def stop(self):
        """Ends it; what it has goes with its folder."""
        self._process.terminate()
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        name, ending = os.path.splitext(self.picture)
        for left in (f"{name}.partial{ending}", name + ".state"):
            if os.path.exists(left):
                os.remove(left)

    def show_preview(self):
        """Brings the picture so far to the image "Petzval"."""
        if self.preview and os.path.exists(self.preview):
            changed = os.stat(self.preview).st_mtime_ns
            if changed != self._seen:
                self._seen = changed
                _load(self.preview)

    def finish(self, scene):
        """Shows the picture. Raises Failed where there is none."""
        self._reader.join(5)
        if self._process.returncode != 0:
            raise Failed("; ".join(self._errors) or f"Petzval ended with {self._process.returncode}")
        if self.preview:
            _load(self.picture)
        scene.petzval.status = "done"


def _load(path):
    image = bpy.data.images.get("Petzval")
    kind = "FLOAT" if path.endswith(".exr") else "BYTE"
    if image and image.get("kind") != kind:
        bpy.data.images.remove(image)
        image = None
    if image is None:
        image = bpy.data.images.load(path)
        image.name = "Petzval"
        image["kind"] = kind
        _show(image)
    else:
        image.filepath = path
        image.reload()


def _show(image):
    if not bpy.context.window_manager:
        return
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR" and (area.spaces.active.image is None or
                                                area.spaces.active.image.name.startswith("Petzval")):
                area.spaces.active.image = image
