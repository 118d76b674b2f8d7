#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of compare.py: closed forms, and a whole run beside made-up pictures of others.

    compare_test.py build/bin/petzval SCENE.glb
"""
import json
import math
import os
import shutil
import sys
import tempfile
import unittest

try:
    import numpy
except ImportError:  # in the form of a skipped test of GoogleTest, which .ci/skipped reads
    print("compare_test.py: Skipped\nnumpy is missing (apt-get install python3-numpy)\n[  SKIPPED ] Fidelity (0 ms)")
    sys.exit(77)

sys.dont_write_bytecode = True
import compare

PROGRAM, SCENE = sys.argv[1:3]


def picture(rgba, height=4, width=6):
    return numpy.tile(numpy.array(rgba, float), (height, width, 1))


class Camera(unittest.TestCase):
    def expect(self, scene, numbers):
        for found, expected in zip(compare.look_at(scene), numbers):
            self.assertAlmostEqual(found, expected, places=12)

    def test_orbits_about_y_from_z_and_down_from_y(self):
        self.expect({}, [0, 0, 1, 0, 0, 0])
        self.expect({"orbit": {"theta": 90, "radius": 2}, "target": {"y": 3}}, [2, 3, 0, 0, 3, 0])
        self.expect({"orbit": {"phi": 60, "radius": 4}, "target": {"x": 1}}, [1, 2, math.sqrt(12), 1, 0, 0])
        self.expect({"orbit": {"theta": -90, "phi": 180, "radius": 1}}, [0, -1, 0, 0, 0, 0])


class Command(unittest.TestCase):
    def test_has_scene_camera_sky_size_exposure_and_picture(self):
        scene = {"name": "a", "model": "a.glb", "lighting": "sky.hdr", "verticalFoV": 30, "exposure": -1.5,
                 "variant": "red one", "renderSkybox": True}
        self.assertEqual(compare.command(scene, "/x", (64, 32), "a.png", spp=7),
                         ["petzval", "render", "/x/a.glb", "--look-at", "0,0,1,0,0,0", "--fov", "30", "--size", "64x32",
                          "--env", "/x/sky.hdr", "--exposure", "-1.5", "--view", "sRGB", "--spp", "7", "--variant",
                          "red one", "-o", "a.png"])
        plain = compare.command({"name": "a", "model": "a.glb"}, "", (8, 8), "a.png")
        self.assertIn("--transparent", plain)
        self.assertEqual(plain[plain.index("--env") + 1], "studio")


class Distance(unittest.TestCase):
    def test_of_greys_is_the_square_of_their_step(self):
        a, b = picture([100, 100, 100, 1]), picture([110, 110, 110, 1])
        # Greys have no I and Q: 0.5053 Y^2 is left, and Y is the step.
        self.assertAlmostEqual(compare.distance_db(a, b), 10 * math.log10(.5053 * 100 / 35215), places=5)
        self.assertEqual(compare.distance_db(a, a), -math.inf)

    def test_counts_what_one_of_the_two_covers(self):
        a, b = picture([0, 0, 0, 0]), picture([0, 0, 0, 0])
        self.assertIsNone(compare.distance_db(a, b))
        a[0, 0] = [0, 0, 0, 1]  # black on white, and nothing else counts
        self.assertAlmostEqual(compare.distance_db(a, b), 10 * math.log10(.5053 * 255 ** 2 / 35215), places=5)
        a[0, 0] = [0, 0, 0, .5]
        self.assertAlmostEqual(compare.distance_db(a, b), 10 * math.log10(.5053 * 127.5 ** 2 / 35215), places=5)

    def test_is_to_the_median_of_the_other_ones(self):
        greys = {name: picture([grey, grey, grey, 1]) for name, grey in (("a", 100), ("b", 110), ("c", 250))}
        found = compare.distances(picture([100, 100, 100, 1]), greys)
        of_step = lambda step: 10 * math.log10(.5053 * step ** 2 / 35215)
        self.assertAlmostEqual(found["petzval"], of_step(10), places=5)  # of 100, 110 and 250 it is 110
        self.assertAlmostEqual(found["a"], of_step(80), places=5)  # of 110 and 250 it is 180
        self.assertAlmostEqual(found["c"], of_step(145), places=5)
        self.assertIsNone(compare.distances(greys["a"], {})["petzval"])
        self.assertIsNone(compare.distances(greys["a"], {"a": greys["a"]})["a"])


class WholeRun(unittest.TestCase):
    def test_puts_our_picture_beside_those_of_others(self):
        with tempfile.TemporaryDirectory() as folder:
            path = lambda *names: os.path.join(folder, *names)
            shutil.copy(SCENE, path("scene.glb"))
            with open(path("list.json"), "w", encoding="utf-8") as file:
                json.dump({"scenarios": [
                    {"name": "gem", "model": "scene.glb", "dimensions": {"width": 24, "height": 16},
                     "orbit": {"theta": 30, "phi": 70, "radius": 3}, "exclude": ["left out"]},
                    {"name": "other", "model": "absent.glb"}]}, file)
            run = lambda: compare.main([path("list.json"), path("pictures"), "-o", path("out"), "--petzval", PROGRAM,
                                        "--spp", "4", "--only", "gem"])
            run()  # without pictures of others
            ours = compare.read_png(path("out", "gem.png"))
            self.assertEqual(ours.shape, (16, 24, 4))
            self.assertTrue((ours[..., 3] > 0).any())
            for name, shift in (("b", 0), ("left out", 90), ("petzval", 90)):
                os.makedirs(path("pictures", name))
                compare.write_png(path("pictures", name, "gem.png"), compare.on_white(ours) + shift)
            os.makedirs(path("pictures", "gem"))
            compare.write_png(path("pictures", "gem", "a-golden.png"), compare.on_white(ours) * 0 + 128)
            run()
            with open(path("out", "table.json"), encoding="utf-8") as file:
                row = json.load(file)[0]
            self.assertEqual(sorted(row["distance_db"]), ["a", "b", "petzval"])
            self.assertEqual(row["command"][-1], path("out", "gem.png"))
            beside = compare.read_png(path("out", "gem-beside.png"))
            self.assertEqual(beside.shape, (16, 4 * 24, 4))
            self.assertTrue((beside[:, 48:72, :3] == 128).all())  # ours, median, a, b
            self.assertTrue((abs(beside[:, 72:, :3] - compare.on_white(ours)) <= .5).all())
            with open(path("out", "table.md"), encoding="utf-8") as file:
                self.assertTrue(file.read().startswith("| scene | petzval | a | b |\n| --- |"))
            # The median of a and b stands half-way: the distance is that of half the step.
            half = compare.distance_db(ours, numpy.median([beside[:, 48:72], beside[:, 72:]], 0))
            self.assertAlmostEqual(row["distance_db"]["petzval"], half, places=6)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
