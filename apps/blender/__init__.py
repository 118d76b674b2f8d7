# SPDX-License-Identifier: Apache-2.0
"""Add-on for Blender 3.4 and newer: renders the scene with Petzval, through a real lens."""
import os
import shutil
import subprocess
import tempfile

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import export, run

bl_info = {
    "name": "Petzval",
    "description": "Renders the scene through a real lens",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render, and Properties > Camera",
    "category": "Render",
}

_LENSES = {}  # by program: Blender wants the items of a list to stay in memory


class PetzvalPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", subtype="FILE_PATH",
                            description="Petzval's program; empty: petzval beside this add-on, or on the path")

    def draw(self, _):
        self.layout.prop(self, "program")
        found = find_program()
        self.layout.label(text=f"Found: {found}" if found else "No program is found: install Petzval, or name it here",
                          icon="CHECKMARK" if found else "ERROR")


def find_program():
    """Path of the program: of the preferences, beside the add-on, or on the path; None where there is none."""
    addon = bpy.context.preferences.addons.get(__package__)
    named = addon and addon.preferences and bpy.path.abspath(addon.preferences.program)
    here = os.path.dirname(os.path.abspath(__file__))
    for path in [named] if named else [os.path.join(here, "petzval"), os.path.join(here, "bin", "petzval"),
                                       shutil.which("petzval")]:
        if path and os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    return None


def lenses(_settings=None, _context=None):
    """Items of the list of lenses."""
    program = find_program()
    if program not in _LENSES:
        items = [("camera", "As the camera", "Pinhole, or a thin lens where the camera has depth of field")]
        if program:
            said = subprocess.run([program, "lens", "list"], capture_output=True, text=True, check=False).stdout
            for line in said.splitlines()[2:]:
                name, focal, fnumber, angle, title = line.split(maxsplit=4)
                items.append((name, f"{name}  {focal} mm {fnumber}", f"{title}; {angle} degrees"))
        _LENSES[program] = items
    return _LENSES[program]


class PetzvalSettings(bpy.types.PropertyGroup):
    lens: EnumProperty(name="Lens", items=lenses, description="A real lens, surface by surface")
    keep_framing: BoolProperty(name="Keep framing", default=True,
                               description="Scale the lens to the camera's angle of view")
    fstop: FloatProperty(name="f-number", min=0, default=0, description="0: that of the lens, or of the camera")
    aperture: StringProperty(name="Iris", description='Shape: "polygon:6", "star:5", FILE.svg; empty: as the camera says')
    dispersion: EnumProperty(name="Dispersion", items=[
        (word, word, text) for word, text in (("auto", "As a test render finds"), ("shared", "No colour fringes"),
                                              ("hero", "One ray for each wavelength"), ("split", "Four rays"))])
    stop_at: EnumProperty(name="Until", items=[("samples", "Samples", "A number of samples for each pixel"),
                                               ("noise", "Noise", "Each part of the picture has at most this noise")])
    samples: IntProperty(name="Samples", min=2, default=64, max=1 << 30)
    noise: FloatProperty(name="Noise (%)", min=0.01, default=3, max=100)
    denoise: BoolProperty(name="Denoise")
    layers: StringProperty(name="Layers", description="As albedo,normal,depth")
    # What the last render said.
    status: StringProperty()
    lost: StringProperty()


def command_of(scene, glb, picture, preview=None):
    """Words of the command that renders an exported scene."""
    own, render = scene.petzval, scene.render
    scale = render.resolution_percentage / 100
    words = [find_program(), "render", glb, *export.frame_words(scene, max(1, round(render.resolution_x * scale)),
                                                                max(1, round(render.resolution_y * scale)))]
    if own.stop_at == "noise":
        words += ["--noise", f"{own.noise:g}%"]
    else:
        words += ["--spp", str(own.samples)]
    if own.lens not in ("", "camera"):
        words += ["--lens", own.lens]
        if own.keep_framing and scene.camera:
            words += ["--method", "fit=fov"]
        if own.dispersion != "auto":
            words += ["--method", f"dispersion={own.dispersion}"]
    for option, value in (("--fstop", own.fstop and f"{own.fstop:g}"), ("--aperture", own.aperture), ("--aov", own.layers)):
        if value:
            words += [option, value]
    if own.denoise:
        words += ["--denoise"]
    if render.film_transparent:
        words += ["--transparent"]
    if preview:
        words += ["--preview", preview]
    return words + ["-o", picture]


class PETZVAL_OT_render(bpy.types.Operator):
    """Render the scene with Petzval. Escape stops"""
    bl_idname = "petzval.render"
    bl_label = "Render with Petzval"
    bl_options = {"REGISTER"}

    animation: BoolProperty(name="Animation", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, _):
        return not run.Render.running

    def _begin(self, context):
        scene = context.scene
        self._before = scene.frame_current
        if not find_program():
            raise run.Failed("Petzval's program is not found; install it, or name it in the add-on's preferences")
        self._frames = list(range(scene.frame_start, scene.frame_end + 1, scene.frame_step)) if self.animation else []
        if self.animation and scene.render.filepath.startswith("//") and not bpy.data.filepath:
            raise run.Failed("save the file first, or name a folder for the frames in the output properties")
        # Blender removes it when it ends; until then the picture is read from there.
        self._folder = tempfile.mkdtemp(prefix="petzval-", dir=bpy.app.tempdir)
        self._begin_frame(context)

    def _begin_frame(self, context):
        scene = context.scene
        picture = os.path.join(self._folder, "Petzval.exr")
        if self.animation:
            scene.frame_set(self._frames.pop(0))
            picture = os.path.splitext(scene.render.frame_path(frame=scene.frame_current))[0] + ".exr"
            os.makedirs(os.path.dirname(picture) or ".", exist_ok=True)
        glb = os.path.join(self._folder, "scene.glb")
        scene.petzval.lost = "\n".join(export.export(glb, scene, framed=True))
        preview = None if self.animation else os.path.join(self._folder, "preview.png")
        self._render = run.Render(command_of(scene, glb, picture, preview), picture, preview)

    def _end(self, context, status):
        context.scene.petzval.status = status
        if self.animation:
            context.scene.frame_set(self._before)
        if status != "done" or self.animation:
            shutil.rmtree(getattr(self, "_folder", ""), ignore_errors=True)
        else:
            run.Render.keep(self._folder)
        run.Render.running = None

    def _step(self, context):
        """Whether it goes on."""
        if not self._render.has_ended():
            return True
        self._render.finish(context.scene)
        if self._frames:
            self._begin_frame(context)
            return True
        return False

    def execute(self, context):
        """Renders before it returns, as a script wants it."""
        try:
            self._begin(context)
            while self._step(context):
                self._render.wait(0.1)
        except Exception as error:  # pylint: disable=broad-except
            return self._fail(context, error)
        self._end(context, "done")
        return {"FINISHED"}

    def _fail(self, context, error):
        self._end(context, str(error))
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}

    def invoke(self, context, _event):
        if bpy.app.background:
            return self.execute(context)
        try:
            self._begin(context)
        except Exception as error:  # pylint: disable=broad-except
            return self._fail(context, error)
        context.window_manager.progress_begin(0, 100)
        self._timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" or self._render.stop_asked:
            self._render.stop()
            return self._leave(context, "stopped", {"CANCELLED"})
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        try:
            goes_on = self._step(context)
        except Exception as error:  # pylint: disable=broad-except
            self.report({"ERROR"}, str(error))
            return self._leave(context, str(error), {"CANCELLED"})
        if not goes_on:
            return self._leave(context, "done", {"FINISHED"})
        fraction = self._render.fraction
        context.window_manager.progress_update(100 * fraction)
        context.scene.petzval.status = f"{self._render.phase} {fraction:.0%}"
        self._render.show_preview()
        for area in context.screen.areas:
            if area.type in ("IMAGE_EDITOR", "PROPERTIES"):
                area.tag_redraw()
        return {"RUNNING_MODAL"}

    def _leave(self, context, status, result):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        self._end(context, status)
        return result


class PETZVAL_OT_stop(bpy.types.Operator):
    """Stop the render"""
    bl_idname = "petzval.stop"
    bl_label = "Stop"

    def execute(self, _):
        if run.Render.running:
            run.Render.running.stop_asked = True
        return {"FINISHED"}


class PETZVAL_OT_copy_command(bpy.types.Operator):
    """Copy the command line that renders an exported scene.glb"""
    bl_idname = "petzval.copy_command"
    bl_label = "Copy command"

    def execute(self, context):
        context.window_manager.clipboard = run.shown(command_of(context.scene, "scene.glb", "picture.exr"))
        return {"FINISHED"}


class PETZVAL_OT_draw_lens(bpy.types.Operator):
    """Show a drawing of the lens in the browser"""
    bl_idname = "petzval.draw_lens"
    bl_label = "Drawing"

    @classmethod
    def poll(cls, context):
        return context.scene.petzval.lens not in ("", "camera")

    def execute(self, context):
        path = os.path.join(bpy.app.tempdir, context.scene.petzval.lens + ".svg")
        done = subprocess.run([find_program(), "lens", "draw", context.scene.petzval.lens, "-o", path], capture_output=True,
                              text=True, check=False)
        if done.returncode:
            self.report({"ERROR"}, done.stderr.strip())
            return {"CANCELLED"}
        bpy.ops.wm.url_open(url="file://" + path)
        return {"FINISHED"}


class PetzvalPanel:
    bl_space_type, bl_region_type, bl_label = "PROPERTIES", "WINDOW", "Petzval"


class PETZVAL_PT_render(PetzvalPanel, bpy.types.Panel):
    bl_context = "render"

    def draw(self, context):
        layout, own = self.layout, context.scene.petzval
        layout.use_property_split = True
        running = run.Render.running
        row = layout.row(align=True)
        row.operator("petzval.render", icon="RENDER_STILL")
        row.operator("petzval.render", text="Animation", icon="RENDER_ANIMATION").animation = True
        if running:
            layout.operator("petzval.stop", icon="CANCEL")
        if own.status:
            layout.label(text=own.status)
        layout.prop(own, "stop_at")
        layout.prop(own, "noise" if own.stop_at == "noise" else "samples")
        layout.prop(own, "denoise")
        layout.prop(own, "layers")
        if find_program():
            layout.label(text=run.shown(command_of(context.scene, "scene.glb", "picture.exr")))
            layout.operator("petzval.copy_command", icon="COPYDOWN")
        else:
            layout.label(text="Petzval's program is not found: see the add-on's preferences", icon="ERROR")
        if own.lost:
            box = layout.box()
            box.label(text="Not rendered:", icon="INFO")
            for line in own.lost.split("\n"):
                box.label(text=line)


class PETZVAL_PT_camera(PetzvalPanel, bpy.types.Panel):
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.camera

    def draw(self, context):
        layout, own, camera = self.layout, context.scene.petzval, context.camera
        layout.use_property_split = True
        layout.prop(own, "lens")
        layout.operator("petzval.draw_lens", icon="FILE_IMAGE")
        layout.prop(own, "keep_framing")
        layout.prop(own, "fstop")
        layout.prop(own, "aperture")
        layout.prop(own, "dispersion")
        layout.prop(camera.dof, "use_dof", text="Focus as set here")
        layout.prop(camera.dof, "focus_object")
        layout.prop(camera.dof, "focus_distance")


CLASSES = (PetzvalPreferences, PetzvalSettings, PETZVAL_OT_render, PETZVAL_OT_stop, PETZVAL_OT_copy_command,
           PETZVAL_OT_draw_lens, PETZVAL_PT_render, PETZVAL_PT_camera)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.petzval = PointerProperty(type=PetzvalSettings)


def unregister():
    if run.Render.running:
        run.Render.running.stop()
    del bpy.types.Scene.petzval
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
