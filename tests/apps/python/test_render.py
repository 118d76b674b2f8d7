# SPDX-License-Identifier: Apache-2.0
"""Renders as values: what is kept, cancelled, refused, and sent to other processes."""
import copy
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import petzval
from conftest import ROOT, run_program

SMALL = {"samples": 2, "size": (32, 18)}


def test_image_has_arrays_and_facts(room):
    image = petzval.render(room, petzval.Camera(fstop=2), samples=8, size=(32, 18), bins=(400, 700, 100),
                           layers=["depth", "normal"], crop=(4, 2, 16, 8))
    assert image.pixels.shape == image.shape == (8, 16, 4) and image.pixels.dtype == np.float32
    assert image.bins.shape == (8, 16, 3) and list(image.bin_edges_nm) == [400, 500, 600, 700]
    assert image.standard_error.shape == image.rgb.shape == (8, 16, 3)
    assert image.layers["depth"].shape == (8, 16) and image.layers["normal"].shape == (8, 16, 3)
    assert image.metadata["petzval:fstop"] == 2 and image.denoised_error is None and image.samples is None
    assert np.may_share_memory(image.pixels, image.layers["depth"]) and not image.pixels.flags.writeable
    assert np.array_equal(np.asarray(image), image.pixels)
    assert "16x8" in repr(image) and any("spectral" in line for line in image.notices)
    shown = image.display()
    assert shown.shape == (8, 16, 4) and shown.min() >= 0 and shown.max() <= 1


def test_pixels_outlive_their_image(room):
    pixels = petzval.render(room, **SMALL).pixels
    again = petzval.render(room, **SMALL).pixels
    assert np.array_equal(pixels, again) and pixels.max() > 0


def test_pose_and_intrinsics_project_what_is_seen(room):
    """Points of the position layer, projected by pose and intrinsics, fall on their own pixels."""
    pose = np.array([[0.6, 0, 0.8, 0.9], [0, 1, 0, 0.9], [-0.8, 0, 0.6, -0.3], [0, 0, 0, 1]])
    turn = np.array([[0.8, -0.6, 0, 0], [0.6, 0.8, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])  # a roll
    camera = petzval.Camera(pose=pose @ turn @ np.diag([1, -1, -1, 1]), axes="opencv", lens="pinhole", fov=50)
    image = petzval.render(room, camera, samples=16, size=(48, 32), layers=["position"], filter="box",
                           crop=(8, 4, 32, 24))
    assert np.allclose(image.pose, pose @ turn, atol=1e-6)
    seen = image.layers["position"][4:-4, 4:-4].reshape(-1, 3)
    hit = (seen != 0).any(axis=1)
    local = (np.c_[seen, np.ones(len(seen))] @ np.linalg.inv(image.pose).T)[:, :3] * [1, -1, -1]
    found = local @ image.intrinsics.T
    found = found[:, :2] / found[:, 2:]
    y, x = np.mgrid[4:20, 4:28] + 0.5
    off = np.hypot(found[:, 0] - x.ravel(), found[:, 1] - y.ravel())
    assert hit.mean() > 0.5 and np.median(off[hit]) < 0.15


def test_scene_is_loaded_once(room):
    phases = []
    petzval.render(room, **SMALL)
    petzval.render(room, petzval.Camera(fov=50), samples=2000, size=(32, 18),
                   progress=lambda progress: phases.append(progress.phase))
    assert phases and "loading" not in phases and "bvh" not in phases


def test_callback_sees_progress_and_its_exception_ends_the_render(room):
    class Enough(Exception):
        pass

    seen = []

    def watch(progress):
        seen.append(progress)
        if progress.phase == "rendering":
            raise Enough

    with pytest.raises(Enough):
        petzval.render(room, samples=1_000_000, size=(32, 18), progress=watch)
    assert seen[-1].total == 1_000_000 * 32 * 18 and 0 <= seen[-1].fraction < 1
    assert petzval.render(room, **SMALL).pixels.max() > 0
    with pytest.raises(petzval.FieldError) as error:
        petzval.render(room, **SMALL, progress=3)
    assert error.value.field == "progress"


def test_ctrl_c_ends_a_render(room):
    timer = threading.Timer(1, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        petzval.render(room, samples=1_000_000, size=(32, 18))
    assert petzval.render(room, **SMALL).pixels.max() > 0


def test_other_threads_run_and_two_renders_need_two_scenes(room):
    stop, ticks, errors = threading.Event(), [], []

    def second():
        while not stop.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.01)
            try:
                petzval.render(room, **SMALL)
            except petzval.FieldError as error:
                errors.append(error)

    begun, other = threading.Event(), petzval.Scene(room.path)
    thread = threading.Thread(target=lambda: (begun.wait(), second()))
    thread.start()
    image = petzval.render(room, samples=400, size=(32, 18), progress=lambda _: begun.set())
    stop.set()
    begun.set()
    thread.join()
    assert len(ticks) > 3 and errors and errors[0].field == "scene"
    assert np.array_equal(petzval.render(other, samples=400, size=(32, 18)).pixels, image.pixels)


def test_numbers_keep_their_denormals(room):
    petzval.render(room, **SMALL)
    assert np.float32(1e-40) * np.float32(0.5) > 0


def render_in_a_child(scene, camera, queue):
    queue.put(petzval.render(scene, camera, **SMALL).pixels.copy())


def test_processes_are_spawned_and_forks_refused(room):
    camera = petzval.Camera(fstop=4)
    expected = petzval.render(room, camera, **SMALL).pixels
    context = multiprocessing.get_context("spawn")
    queue = context.Queue()
    child = context.Process(target=render_in_a_child, args=(room, camera, queue))
    child.start()
    assert np.array_equal(queue.get(timeout=120), expected)
    child.join()
    read, write = os.pipe()
    if (pid := os.fork()) == 0:
        try:
            petzval.render(room, **SMALL)
        except petzval.Error as error:
            os.write(write, str(error).encode())
        os._exit(0)
    os.waitpid(pid, 0)
    assert b"spawn" in os.read(read, 1000)


def test_many_renders_do_not_grow(room):
    def resident_pages():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1])

    def several(count):
        for i in range(count):
            petzval.render(room, petzval.Camera(fov=30 + i), samples=1, size=(16, 9))

    several(10)
    before = resident_pages()
    several(40)
    assert resident_pages() - before < 2000  # pages of 4 kB: a picture of the scene alone has 4,000


def test_save_spares_inputs_and_says_what_it_cannot(everything, tmp_path):
    scene = petzval.Scene(everything, env=np.ones((8, 16, 3)))
    image = petzval.render(scene, samples=1, size=(16, 9))
    link = tmp_path / "link.png"
    link.symlink_to(everything)
    for path in (link, scene._fields.texts["env"][0]):
        with pytest.raises(petzval.InputError):
            image.save(path)
    with pytest.raises(petzval.OutputError, match="no/folder"):
        image.save(tmp_path / "no/folder.exr")
    for path in (tmp_path / "picture.bmp", "a\0.png", 3):
        with pytest.raises(petzval.Error):
            image.save(path)


def test_what_is_given_later_goes_before(everything):
    scene = petzval.Scene(everything, transparent=True, background=(1, 1, 1))
    camera = petzval.Camera(fov=20)
    assert petzval.render(scene, camera, samples=1, size=(16, 9)).pixels[..., 3].min() == 0
    image = petzval.render(scene, camera, samples=1, size=(16, 9), transparent=False, fov=30, layers=[])
    assert image.pixels[..., 3].min() == 1 and abs(image.metadata["petzval:fov_deg"] - 30) < 1e-4


def test_camera_takes_a_lens_with_its_focus_and_glasses(everything, tmp_path):
    lens = petzval.Lens("double-gauss-100mm-f2").focused(1.0)
    image = petzval.render(petzval.Scene(everything, env="studio"), petzval.Camera(lens=lens), **SMALL)
    assert image.focus_m == 1 and abs(image.metadata["petzval:film_mm"] - lens.film_mm) < 1e-3
    nearer = petzval.Camera(lens=lens, focus=0.8)
    assert abs(petzval.render(petzval.Scene(everything, env="studio"), nearer, **SMALL).focus_m - 0.8) < 1e-6
    lens.film_mm += 1
    with pytest.raises(petzval.FieldError, match="film"):
        petzval.Camera(lens=lens)


@pytest.mark.parametrize("lens, focus", [("double-gauss-100mm-f2", 1.2), ("takumar-50mm-f1.2", 0.6), ("thin", 1),
                                         ("schneider-anamorphic-31mm", 1.5)])
def test_intrinsics_are_those_of_the_focus_that_is_set(lens, focus, room):
    """Points about the middle of the picture, by their positions."""
    more = {"focal_length": 50, "fstop": 16} if lens == "thin" else {"fstop": 16}
    image = petzval.render(room, petzval.Camera(lens=lens, focus=focus, **more), samples=64, size=(60, 40),
                           layers=["position"], filter="box")
    seen = image.layers["position"]
    local = (np.dstack([seen, np.ones((40, 60))]) @ np.linalg.inv(image.pose).T)[..., :3] * [1, -1, -1]
    y, x = np.mgrid[:40, :60] + 0.5
    about = (np.abs(seen) > 0).any(axis=2) & (np.hypot(x - 30, y - 20) < 15)
    for axis, aside in ((0, x - 30), (1, y - 20)):
        there = about & (np.abs(aside) > 4)
        found = image.intrinsics[axis, axis] * local[..., axis][there] / local[..., 2][there]
        most = 0.03 if "anamorphic" in lens else 0.01  # whose two sections have two entrance pupils
        assert there.sum() > 50 and abs(np.median(found / aside[there]) - 1) < most


def test_copies_outlive_what_they_are_copied_from():
    square = petzval.Mesh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]])
    scene = petzval.Scene.from_arrays([square], env=np.ones((8, 16, 3)))
    camera = petzval.Camera(look_at=(0, 0, 4, 0, 0, 0))
    pixels = petzval.render(scene, camera, **SMALL).pixels
    copies = [copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))]
    folder = os.path.dirname(scene.path)
    del scene
    assert not os.path.exists(folder)
    for one in copies:
        assert np.array_equal(petzval.render(one, pickle.loads(pickle.dumps(camera)), **SMALL).pixels, pixels)


FORK = """
import multiprocessing, sys
import numpy as np
import petzval
scene = petzval.Scene({scene!r}, env=np.ones((64, 128, 3)))
def view(i):
    try:
        return petzval.render(scene, orbit=i, samples=1, size=(16, 9)).pixels.mean()
    except petzval.Error as error:
        return str(error)
print(multiprocessing.get_context("fork").Pool(1).map(view, [0, 90]))
"""
EXIT = """
import threading, time
import petzval
scene = petzval.Scene({scene!r})
threading.Thread(target=lambda: petzval.render(scene, samples=10**9, size=(32, 18)), daemon=True).start()
time.sleep(1)
"""


def test_forks_are_refused_before_they_wait_for_ever(room):
    done = subprocess.run([sys.executable, "-c", FORK.format(scene=room.path)], capture_output=True, text=True, timeout=60)
    assert "spawn" in done.stdout, done.stderr


def test_python_ends_while_a_thread_renders(room):
    done = subprocess.run([sys.executable, "-c", EXIT.format(scene=room.path)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "terminate" not in done.stderr, done.stderr


def test_progress_counts_the_samples_that_are_there(room):
    class Enough(Exception):
        pass

    reached = []

    def stop(progress):
        if progress.phase == "rendering" and progress.pixel_samples > 0:
            reached.append(progress)
            raise Enough

    asked = {"samples": 3000, "size": (32, 18)}
    for _ in range(2):
        with pytest.raises(Enough):
            petzval.render(room, **asked, progress=stop)
    assert reached[1].pixel_samples > reached[0].pixel_samples and reached[1].total == 3000 * 32 * 18


def test_errors_name_the_field(room, tmp_path):
    cases = {
        "size": [(0, 5), "x", (100000, 100000), (60000, 60000), 3], "samples": [-1, float("nan"), "many", 1.5, 10**12],
        "focus": [{}, object(), -1, float("nan")], "layers": ["nope", [1, 2], 3], "denoise": [1, "on"],
        "env": [np.zeros((3, 3)), np.full((4, 8, 3), np.nan), -np.ones((4, 8, 3)), "nothing.hdr", np.zeros((0, 8, 3)),
                np.full((4, 8, 3), 1e300)],
        "pose": [np.eye(3), np.full((4, 4), np.nan), 2 * np.eye(4), np.diag([1, 1, -1, 1]), np.array(["a"] * 12),
                 np.eye(4) + np.eye(4, k=-3)],
        "fstop": [True, None.__class__, np.array([1, 2])], "noise": ["200%", -1],
        "illuminant": [petzval.Spectrum([400, 500], [1, -1])],
        "lens": ["takumar-50mm-f1.3", 3], "background": [(1, 2), (1, 2, -3)]}
    for keyword, values in cases.items():
        for value in values:
            with pytest.raises(petzval.Error) as error:
                petzval.render(room, **{**SMALL, keyword: value})
            assert error.value.field == keyword, (keyword, value, error.value)
            assert "⟨" not in str(error.value) and "--" not in str(error.value)
            assert isinstance(pickle.loads(pickle.dumps(error.value)), type(error.value))
    with pytest.raises(petzval.FieldError, match="fstop excludes lens_radius|lens_radius"):
        petzval.render(room, petzval.Camera(fstop=2, lens_radius=0.01), **SMALL)
    with pytest.raises(TypeError, match="fstp"):
        petzval.render(room, fstp=2)
    for scene in ("room.glb", 3, None):
        with pytest.raises(petzval.FieldError):
            petzval.render(scene, **SMALL)
    gone = petzval.Scene(tmp_path / "gone.glb")
    with pytest.raises(petzval.InputError) as error:
        petzval.render(gone, **SMALL)
    assert error.value.field == "file"
    assert petzval.render(room, **SMALL).pixels.max() > 0


def test_values_may_be_of_many_types(everything):
    scene = petzval.Scene(everything, at=0.5, animation=0, variant=np.str_("red"), env="studio")
    image = petzval.render(scene, samples=np.float64(2), seed=1e3, size=np.array([24.0, 16.0]), crop=(0, 0, 8.0, 8),
                           layers=np.array(["depth", "normal"]), fov=np.float32(30))
    assert image.shape == (8, 8, 4) and image.metadata["petzval:seed"] == "1000" and len(image.layers) == 2


def test_names_of_files_need_not_be_utf_8(everything, tmp_path):
    name = os.fsdecode(os.fsencode(tmp_path) + b"/\xff \xc3\xa4.glb")
    os.link(everything, name)
    image = petzval.render(petzval.Scene(name), samples=1, size=(16, 9))
    image.save(name + ".png")
    assert os.path.getsize(name + ".png") > 0
    with pytest.raises(petzval.InputError) as error:
        petzval.render(petzval.Scene(name + "x"), samples=1, size=(16, 9))
    assert "\udcff" in str(error.value) and error.value.field == "file"


def test_plan_says_what_the_command_line_says(everything):
    asked = {"size": (48, 32), "tolerance": 0.2}
    plan = petzval.plan(petzval.Scene(everything, env="studio"),
                        petzval.Camera(lens="singlet:N-BK7", focal_length=50, fstop=4), **asked)
    said = json.loads(run_program("plan", everything, "--env", "studio", "--lens", "singlet:N-BK7", "--focal-length",
                                  "50", "--fstop", "4", "--size", "48x32", "--tolerance", "20%", "--json", "--quiet"))
    clocks = {"predicted_cpu_s", "predicted_wall_s"}
    for name in set(plan) - {"fields"} - clocks:
        if name not in ("spectral", "dispersion"):  # their reasons name times
            assert plan[name] == said[name], name


def test_plan_gives_keywords_for_render(everything):
    scene = petzval.Scene(everything, transparent=True, env=np.ones((8, 16, 3)))
    plan = petzval.plan(scene, petzval.Camera(fstop=4, focal_length=50), size=(48, 32), tolerance=0.2)
    fields = {**plan["fields"], "samples": 2}
    assert fields["transparent"] is True and "samples" in plan["fields"]
    assert petzval.render(petzval.Scene(everything), **fields).shape == (32, 48, 4)
    with pytest.raises(TypeError):
        petzval.plan(scene, samples=4)


def test_chart_gives_its_points(everything, tmp_path):
    scene = petzval.Scene(everything, env="studio")
    found = petzval.chart(scene, axes="sampler", budget="8s", size=(16, 10), folder=tmp_path / "report")
    methods = {method["name"] for case in found["cases"] for method in case["methods"]}
    assert "owen" in methods and (tmp_path / "report/report.html").exists()
    for field, wrong in (("axes", {"axes": ["colour"]}), ("seeds", {"seeds": 0}), ("budget", {"budget": "soon"}),
                         ("bins", {"bins": (400, 700, 10)}), ("folder", {"folder": tmp_path / "x.csv"})):
        with pytest.raises(petzval.FieldError) as error:
            petzval.chart(scene, **wrong)
        assert error.value.field == field
