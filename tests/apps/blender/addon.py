# SPDX-License-Identifier: Apache-2.0
"""The add-on as a user has it: installed from its zip, without a window.

    blender -b --factory-startup -noaudio --python-exit-code 1 -P tests/apps/blender/addon.py -- PETZVAL ZIP
"""
import os
import subprocess
import sys
import tempfile
import time

import bpy

program, package = sys.argv[sys.argv.index("--") + 1:]
own_folder = tempfile.mkdtemp()
os.environ["PATH"] = os.path.dirname(program) + ":" + os.environ["PATH"]


def refused(**values):
    try:
        bpy.ops.petzval.render(**values)
    except RuntimeError as error:
        return str(error)
    raise AssertionError("it was not refused")


def left():
    return [name for name in os.listdir(bpy.app.tempdir) if name.startswith("petzval-")]


bpy.ops.preferences.addon_install(filepath=package)
bpy.ops.preferences.addon_enable(module="petzval_blender")
addon = sys.modules["petzval_blender"]
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y = 64, 36
own = scene.petzval
assert "takumar-50mm-f1.2" in [item[0] for item in addon.lenses()]

# A picture with layers, and what is not rendered.
own.lens, own.fstop, own.samples, own.layers = "takumar-50mm-f1.2", 2, 4, "depth,normal"
assert bpy.ops.petzval.render() == {"FINISHED"} and own.status == "done"
assert "takes its place" in own.lost
image = bpy.data.images["Petzval"]
assert image.size[:] is not None and image.type == "MULTILAYER" and os.path.exists(image.filepath)
said = addon.run.shown(addon.run.command_of(scene, "scene.glb", "picture.exr"))
assert said == ("petzval render scene.glb --size 64x36 --sensor 36x20.25 --spp 4 --method fit=fov --lens takumar-50mm-f1.2 "
                "--fstop 2 --aov depth,normal -o picture.exr"), said

scene.camera.data.shift_x = 0.1
assert bpy.ops.petzval.render() == {"FINISHED"} and "shift" not in own.lost
assert "--size 77x36 --crop 13,0,64,36 --fov" in addon.run.shown(addon.run.command_of(scene, "s.glb", "p.exr"))
scene.camera.data.shift_x = 0

# An export that fails leaves nothing in the file.
kinds = ("scenes", "objects", "meshes", "materials")
counts = [len(getattr(bpy.data, kind)) for kind in kinds]
meshes = sys.modules[addon.__name__ + ".meshes"]
whole, meshes.is_closed = meshes.is_closed, None
assert "NoneType" in refused() and own.status
meshes.is_closed = whole
assert counts == [len(getattr(bpy.data, kind)) for kind in kinds]

# Frames.
scene.render.filepath = os.path.join(own_folder, "frames", "f")
scene.frame_end = 2
assert bpy.ops.petzval.render(animation=True) == {"FINISHED"}
assert sorted(os.listdir(os.path.join(own_folder, "frames"))) == ["f0001.exr", "f0002.exr"] and scene.frame_current == 1

# What goes wrong is told, and leaves nothing.
before = left()
own.aperture = "nonsense"
assert "nonsense: is neither a file nor a shape" in refused()
own.aperture = ""
scene.render.filepath = "/proc/no"
assert "/proc" in refused(animation=True)
scene.render.filepath = "//frames/"
assert "save the file first" in refused(animation=True)
broken = os.path.join(own_folder, "petzval")
with open(broken, "w", encoding="utf-8") as file:
    file.write("#!/bin/sh\nexit 3\n")
os.chmod(broken, 0o755)
bpy.context.preferences.addons["petzval_blender"].preferences.program = broken
assert "ended with 3" in refused()
bpy.context.preferences.addons["petzval_blender"].preferences.program = "/no/petzval"
assert "is not found" in refused()
bpy.context.preferences.addons["petzval_blender"].preferences.program = ""
bpy.data.objects.remove(scene.camera)
assert bpy.ops.petzval.render() == {"FINISHED"} and "a camera" in own.lost
assert len(left()) == len(before) == 1  # of the last picture

# Two at once are refused; one that is stopped is gone; one whose Blender dies goes too.
own.samples = 1 << 20
words = addon.run.command_of(scene, os.path.join(left()[-1], "no.glb"), "x.exr")
bpy.ops.export_scene.gltf(filepath=os.path.join(own_folder, "s.glb"))
words[2] = os.path.join(own_folder, "s.glb")
words[-1] = os.path.join(own_folder, "x.exr")
one = addon.run.follow(words, words[-1])
assert next(one)[0]
time.sleep(1)
one.close()
assert sorted(os.listdir(own_folder)) == ["frames", "petzval", "s.glb"]
addon.run.Now.work = addon.run.render(scene, False)
next(addon.run.Now.work)
assert "runs already" in refused()
addon.run.Now.work.close()
assert own.status == "stopped" and not addon.run.Now.work and len(left()) == 1
child = subprocess.Popen([sys.executable if "python" in sys.executable else "python3", "-c", f"""
import ctypes, signal, subprocess, time
print(subprocess.Popen({words!r}, preexec_fn=lambda: ctypes.CDLL(None).prctl(1, signal.SIGTERM)).pid, flush=True)
time.sleep(60)"""], stdout=subprocess.PIPE, text=True)
pid = int(child.stdout.readline())
time.sleep(1)
child.kill()
time.sleep(1)
assert not os.path.exists(f"/proc/{pid}") or "zombie" in open(f"/proc/{pid}/status").read()
bpy.ops.preferences.addon_disable(module="petzval_blender")
assert not hasattr(scene, "petzval")
print("the add-on works")
