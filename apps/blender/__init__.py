# SPDX-License-Identifier: Apache-2.0
"""Add-on for Blender 3.4 and newer: renders the scene with Petzval, through a real lens."""
import os
import subprocess
import textwrap
import time

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import run

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
        found = run.find_program()
        self.layout.label(text=f"Found: {found}" if found else "No program is found: install Petzval, or name it here",
                          icon="CHECKMARK" if found else "ERROR")


def lenses(_settings=None, _context=None):
    """Items of the list of lenses."""
    program = run.find_program()
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


class PETZVAL_OT_render(bpy.types.Operator):
    """Render the scene with Petzval, or stop. Escape stops too"""
    bl_idname = "petzval.render"
    bl_label = "Render with Petzval"
    bl_options = {"REGISTER"}

    animation: BoolProperty(name="Animation", options={"SKIP_SAVE"})

    def execute(self, context):
        """Renders before it returns, as a script wants it."""
        if run.Now.work:
            self.report({"ERROR"}, "a render runs already")
            return {"CANCELLED"}
        run.Now.work = run.render(context.scene, self.animation)
        while not (result := self._step(context)):
            time.sleep(0.1)
        return result

    def _step(self, context):
        """What Blender is told at the end; None before."""
        try:
            phase, fraction = next(run.Now.work)
        except StopIteration:
            return {"FINISHED"}
        except Exception as error:  # pylint: disable=broad-except
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.scene.petzval.status = f"{phase} {fraction:.0%}"
        context.window_manager.progress_update(100 * fraction)
        return None

    def invoke(self, context, _event):
        if run.Now.work:  # then the button says so
            run.Now.work.close()
            return {"FINISHED"}
        if bpy.app.background:
            return self.execute(context)
        run.Now.work = run.render(context.scene, self.animation)
        context.window_manager.progress_begin(0, 100)
        self._timer = context.window_manager.event_timer_add(0.2, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def cancel(self, _):
        """Blender opens another file."""
        if run.Now.work:
            run.Now.work.close()

    def modal(self, context, event):
        if run.Now.work and event.type == "ESC":
            run.Now.work.close()
        if run.Now.work and event.type != "TIMER":
            return {"PASS_THROUGH"}
        result = self._step(context) if run.Now.work else {"CANCELLED"}
        for area in context.screen.areas if context.screen else ():
            if area.type in ("IMAGE_EDITOR", "PROPERTIES"):
                area.tag_redraw()
        if not result:
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        return result


class PETZVAL_OT_copy_command(bpy.types.Operator):
    """Copy the command line that renders an exported scene.glb"""
    bl_idname = "petzval.copy_command"
    bl_label = "Copy command"

    def execute(self, context):
        context.window_manager.clipboard = run.shown(run.command_of(context.scene))
        return {"FINISHED"}


class PETZVAL_OT_draw_lens(bpy.types.Operator):
    """Show a drawing of the lens in the browser"""
    bl_idname = "petzval.draw_lens"
    bl_label = "Drawing"

    @classmethod
    def poll(cls, context):
        return context.scene.petzval.lens not in ("", "camera")

    def execute(self, context):
        name = context.scene.petzval.lens
        path = os.path.join(bpy.app.tempdir, name + ".svg")
        done = subprocess.run([run.find_program(), "lens", "draw", name, "-o", path], capture_output=True, text=True, check=False)
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
        row = layout.row(align=True)
        if run.Now.work:
            row.operator("petzval.render", text="Stop", icon="CANCEL")
        else:
            row.operator("petzval.render", icon="RENDER_STILL")
            row.operator("petzval.render", text="Animation", icon="RENDER_ANIMATION").animation = True
        if own.status:
            layout.label(text=own.status)
        for name in ("stop_at", own.stop_at, "denoise", "layers"):
            layout.prop(own, name)
        layout.prop(context.scene.view_settings, "exposure")
        if run.find_program():
            layout.label(text=run.shown(run.command_of(context.scene)))
            layout.operator("petzval.copy_command", icon="COPYDOWN")
        else:
            layout.label(text="Petzval's program is not found: see the add-on's preferences", icon="ERROR")
        if own.lost:
            box = layout.box()
            box.label(text="Not rendered:", icon="INFO")
            for line in own.lost.split("\n"):
                for part in textwrap.wrap("– " + line, 56):
                    box.label(text=part)


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
        for name in ("keep_framing", "fstop", "aperture", "dispersion"):
            layout.prop(own, name)
        for name in ("use_dof", "focus_object", "focus_distance"):
            layout.prop(camera.dof, name)
        layout.prop(camera, "sensor_fit")
        layout.prop(camera, "sensor_height" if camera.sensor_fit == "VERTICAL" else "sensor_width")


CLASSES = (PetzvalPreferences, PetzvalSettings, PETZVAL_OT_render, PETZVAL_OT_copy_command, PETZVAL_OT_draw_lens,
           PETZVAL_PT_render, PETZVAL_PT_camera)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.petzval = PointerProperty(type=PetzvalSettings)


def unregister():
    if run.Now.work:
        run.Now.work.close()
    del bpy.types.Scene.petzval
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
