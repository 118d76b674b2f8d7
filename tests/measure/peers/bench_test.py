#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of what bench.py and until.py compute, on pictures whose noise is known."""
import json
import math
import os
import random
import struct
import sys
import tempfile
import unittest
import zlib

try:
    import numpy
except ImportError:  # in the form of a skipped test of GoogleTest, which .ci/skipped reads
    print("bench_test.py: Skipped\nnumpy is missing (apt-get install python3-numpy)\n[  SKIPPED ] Bench (0 ms)")
    sys.exit(77)

sys.dont_write_bytecode = True
import noise
import rooms
import scenes
import table


def noisy(sigma, seeds=8, pixels=20000):
    """Pictures of mean 1 with Gaussian noise."""
    return numpy.random.default_rng(1).normal(1, sigma, (seeds, pixels, 3))


def program(sigma, cpu_s):
    return {"sample_cpu_s": [cpu_s] * 8, "whole_cpu_s": [100 * cpu_s] * 8, "mean": 1., **noise.noise(noisy(sigma))}


class Noise(unittest.TestCase):
    def test_is_the_relative_variance(self):
        found = noise.summaries(noise.pixel_errors(noisy(.1)))
        self.assertAlmostEqual(found["plain"], .01 / 1.01, delta=1e-4)
        self.assertAlmostEqual(found["trimmed"], found["plain"], delta=1e-4)
        self.assertLess(found["typical"], found["plain"])

    def test_does_not_depend_on_the_number_of_seeds_nor_on_brightness(self):
        few, many = (noise.summaries(noise.pixel_errors(s * noisy(.1, n)))["plain"] for s, n in ((1, 2), (7, 16)))
        self.assertAlmostEqual(few / many, 1, delta=.03)

    def test_trimming_leaves_the_brightest_errors_out(self):
        pictures = noisy(.1)
        pictures[3, :20] = 1000
        found = noise.summaries(noise.pixel_errors(pictures))
        self.assertGreater(found["plain"], .015)
        self.assertLess(found["trimmed"], .0102)

    def test_the_typical_pixel_is_none_of_mere_sky(self):
        pictures = numpy.concatenate((noisy(.1), noisy(1e-4, pixels=30000)), 1)
        self.assertEqual(noise.summaries(noise.pixel_errors(pictures))["typical"],
                         numpy.median(noise.pixel_errors(pictures)[:20000]))

    def test_agrees_with_the_error_against_the_truth(self):
        pictures = noisy(.1)
        self.assertAlmostEqual(noise.error_against(pictures, numpy.ones(pictures.shape[1:]))["plain"],
                               noise.summaries(noise.pixel_errors(pictures))["plain"], delta=1e-4)


class TrueError(unittest.TestCase):
    def test_is_that_of_the_pictures_and_not_of_the_two_that_they_are_held_against(self):
        dice = numpy.random.default_rng(3)
        one, other, first, second = (1 + dice.normal(0, sigma, (100, 100, 3)) for sigma in (.1, .1, .2, .2))
        found = noise.true_error([one, other], first, second)
        scale = math.sqrt(1 + .25 ** 2)  # the floor is a quarter of the mid-grey, of 1 here
        self.assertAlmostEqual(found["all"], .1 / scale, delta=.003)
        self.assertAlmostEqual(found["trimmed"], .1 / scale, delta=.004)
        self.assertAlmostEqual(noise.error_of_each(first, second)["all"], .2 / scale, delta=.003)

    def test_is_not_less_than_it_can_be_known(self):
        dice = numpy.random.default_rng(4)
        first, second = (1 + dice.normal(0, .5, (96, 96, 3)) for _ in "12")
        found = noise.true_error([numpy.ones((96, 96, 3))], first, second)
        self.assertGreaterEqual(found["all"] ** 2, found["deviation_of_square"] * (1 - 1e-9))
        self.assertLess(found["all"], .1)

    def test_knows_the_mean_of_neighbours_at_edges_too(self):
        self.assertTrue(numpy.allclose(noise.surroundings(numpy.full((9, 12, 3), 2.)), 2))
        ramp = numpy.arange(20.).reshape(1, 20, 1) * numpy.ones((10, 1, 3))
        found = noise.surroundings(ramp)
        self.assertAlmostEqual(found[4, 10, 0], 10)
        self.assertAlmostEqual(found[0, 0, 0], 1.5)  # of 0 to 3

    def test_the_worst_pixels_are_left_out_of_the_trimmed(self):
        picture = numpy.ones((96, 96, 3))
        picture[50, 50] = 97
        found = noise.true_error([picture], *(numpy.ones_like(picture),) * 2)
        self.assertAlmostEqual(found["all"], 1 / math.sqrt(1.0625), delta=1e-6)
        self.assertEqual(found["trimmed"], 0)

    def test_a_black_picture_has_no_error(self):
        black = numpy.zeros((32, 32, 3))
        self.assertEqual(noise.true_error([black], black, black)["all"], 0)


class Until(unittest.TestCase):
    POINTS = [{"cpu_s": 1, "all": .4}, {"cpu_s": 4, "all": .2}, {"cpu_s": 64, "all": .05}]

    def test_is_on_the_line_between_two_points(self):
        for wanted, cpu_s in ((.2, 4), (.1, 16)):
            found, known = table.cpu_s_at(wanted, self.POINTS, "all")
            self.assertAlmostEqual(found, cpu_s)
            self.assertEqual(known, "")

    def test_is_a_guess_or_a_bound_beyond_them(self):
        found, known = table.cpu_s_at(.025, self.POINTS, "all")
        self.assertAlmostEqual(found, 256)
        self.assertEqual(known, "about ")
        self.assertEqual(table.cpu_s_at(.5, self.POINTS, "all"), (1, "at most "))


class Table(unittest.TestCase):
    def test_ratios_are_above_one_where_petzval_is_better(self):
        found = table.ratios(program(.1, 1), program(.2, 3))
        self.assertAlmostEqual(found["speed"], 3)
        self.assertAlmostEqual(found["error plain"], 4, delta=.05)
        self.assertAlmostEqual(found["efficiency trimmed"]["ratio"], 12, delta=.15)

    def test_the_interval_holds_the_true_ratio(self):
        dice, held = numpy.random.default_rng(2), 0
        for _ in range(100):
            one, other = (noise.noise(dice.normal(1, s, (8, 2, 3))) for s in (.1, .1))
            ratio = noise.jackknife(other["all"]["plain"] / one["all"]["plain"], [
                b["plain"] / a["plain"] for a, b in zip(one["without"], other["without"])])
            held += ratio["low"] < 1 < ratio["high"]
        self.assertGreater(held, 84)

    def test_a_mean_of_one_row_is_that_row_and_many_rows_settle_it(self):
        one = noise.jackknife(2., [1.9, 2.2, 2.05, 1.8])
        for key, value in noise.geometric_mean([one]).items():
            self.assertAlmostEqual(value, one[key])
        many = noise.geometric_mean([one] * 16)
        self.assertAlmostEqual(many["ratio"], 2)
        self.assertLess(math.log(many["high"] / 2), math.log(one["high"] / 2) / 4)

    def test_the_worst_row_comes_first_and_last(self):
        done = {"good": {"a": program(.1, 1), "b": program(.2, 1)}, "bad": {"a": program(.2, 1), "b": program(.1, 1)}}
        lines = table.markdown(done, ["a", "b"]).strip().splitlines()
        self.assertTrue(lines[4].startswith("| bad"))
        self.assertTrue(lines[-1].startswith("| worst row: bad"))
        self.assertIn("| 1 |", lines[-2])


class NewOverOld(unittest.TestCase):
    def program(self, sigma, cpu_s, seeds):
        errors = noise.with_each_left_out(lambda p: noise.error_against(p, numpy.ones((20000, 3))),
                                          noisy(sigma, seeds))
        return {"cpu_s": cpu_s, "mean": 1 + sigma, **errors}

    def test_cost_and_error_below_one_make_efficiency_above_one(self):
        found = table.new_over_old(self.program(.2, [2, 2, 4, 2], 4), self.program(.1, [1, 1, 2, 1], 4))
        self.assertAlmostEqual(found["CPU time"]["ratio"], .5)
        self.assertAlmostEqual(found["CPU time"]["log_error"], 0)
        self.assertAlmostEqual(found["brightness"], 1.1 / 1.2)
        for measure in noise.MEASURES:
            self.assertAlmostEqual(found["error " + measure]["ratio"], .25, delta=.002)
            self.assertAlmostEqual(found["efficiency " + measure]["ratio"] * found["error " + measure]["ratio"], 2)

    def test_a_cost_that_differs_between_seeds_has_an_interval(self):
        found = table.new_over_old(self.program(.1, [1, 1, 1, 1], 4), self.program(.1, [1, 1.2, 1, 1], 4))
        self.assertAlmostEqual(found["CPU time"]["ratio"], 1.05)
        self.assertTrue(found["CPU time"]["low"] < 1 < found["CPU time"]["high"])

    def test_two_seeds_have_no_interval(self):
        found = table.new_over_old(self.program(.1, [1, 1], 2), self.program(.1, [1, 3], 2))
        self.assertEqual((found["CPU time"]["ratio"], found["CPU time"]["low"]), (2, None))


class Scenes(unittest.TestCase):
    def test_rooms_are_whole_files_whose_faces_look_outwards(self):
        m = rooms.Model()
        m.box("wall", (-1, -1, -1), (1, 1, 1), 30)
        m.sphere("gold", (0, 0, 0), 1)
        m.turned("red", (0, 0, 0), ((0, 0), (1, 0), (.9, 1), (.8, 1), (0, .1)), (.5, 0, .2))
        m.crossed_cards("leaf", numpy.zeros(3), 1, random.Random(1))
        for positions, normals, triangles, _ in m.parts.values():
            p, n, t = (numpy.concatenate(x) for x in (positions, normals, triangles))
            a, b, c = (p[t[:, i]] for i in range(3))
            self.assertGreater((numpy.cross(b - a, c - a) * n[t[:, 0]]).sum(-1).min(), 0)

    def test_a_cone_stands_on_its_foot_and_leans(self):
        m = rooms.Model()
        m.turned("shaft", (1, 2, 3), ((.5, 0), (0, 2)), (.5, 0, .25))
        points = numpy.concatenate(m.parts["shaft"][0])
        numpy.testing.assert_allclose(points[points[:, 1].argmax()], (2, 4, 3.5))
        rim = points[points[:, 1] < 3] - (1, 2, 3)
        numpy.testing.assert_allclose(numpy.linalg.norm(rim, axis=1), .5)

    def test_leaves_and_glass_keep_their_alpha_and_their_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            m = rooms.Model()
            m.box("black glass", (0, 0, 0), (1, 1, 1))
            m.crossed_cards("leaf", numpy.zeros(3), 1, random.Random(1))
            m.write(os.path.join(folder, "x.glb"))
            with open(os.path.join(folder, "x.glb"), "rb") as file:
                data = file.read()
        length, = struct.unpack_from("<I", data, 12)
        gltf, data = json.loads(data[20:20 + length]), data[28 + length:]
        glass, leaf = gltf["materials"]
        self.assertEqual((glass["alphaMode"], glass["pbrMetallicRoughness"]["baseColorFactor"][3]), ("BLEND", .25))
        self.assertEqual((leaf["alphaMode"], leaf["alphaCutoff"]), ("MASK", .5))
        of_glass, of_leaf = (p["attributes"] for p in gltf["meshes"][0]["primitives"])
        self.assertNotIn("TEXCOORD_0", of_glass)
        self.assertEqual(gltf["accessors"][of_leaf["TEXCOORD_0"]]["count"], 8)
        self.assertEqual(len(data), gltf["buffers"][0]["byteLength"])
        view = gltf["bufferViews"][gltf["images"][0]["bufferView"]]
        picture, at, content = data[view["byteOffset"]:][:view["byteLength"]], 8, b""
        while at < len(picture):
            length, kind = struct.unpack_from(">I4s", picture, at)
            self.assertEqual(struct.unpack_from(">I", picture, at + 8 + length)[0],
                             zlib.crc32(picture[at + 4:at + 8 + length]))
            content += picture[at + 8:][:length] if kind == b"IDAT" else b""
            at += 12 + length
        rows = numpy.frombuffer(zlib.decompress(content), numpy.uint8).reshape(512, -1)
        numpy.testing.assert_array_equal(rows[:, 1:], rooms.leaf_picture().reshape(512, -1))
        opaque = rooms.leaf_picture()[..., 3] > 127
        self.assertTrue(.2 < opaque.mean() < .6 and not (opaque[0].any() or opaque[:, 0].any() or opaque[:, -1].any()))

    def test_a_sun_points_where_it_should(self):
        for d in ((1, -.75, -.25), (0, -1, 0), (0, 0, -1)):
            x, y, z, w = rooms.turn_from_minus_z(d)
            turned = (-2 * (x * z + w * y), -2 * (y * z - w * x), -1 + 2 * (x * x + y * y))
            numpy.testing.assert_allclose(turned, numpy.array(d) / math.hypot(*d), atol=1e-12)

    def test_all_materials_are_two_sided_and_the_rest_stays(self):
        with tempfile.TemporaryDirectory() as folder:
            m = rooms.Model()
            m.box("wall", (0, 0, 0), (1, 1, 1))
            source = os.path.join(folder, "in.glb")
            m.write(source)
            with open(source, "rb") as file:
                before = file.read()
            with open(source, "wb") as file:
                file.write(before.replace(b'"doubleSided": true', b'"doubleSided":false'))
            with open(scenes.prepare(scenes.Row("x", source, [], [], 40), folder), "rb") as file:
                after = file.read()
        length, = struct.unpack_from("<I", after, 12)
        self.assertEqual(struct.unpack_from("<I", after, 8)[0], len(after))
        self.assertTrue(json.loads(after[20:20 + length])["materials"][0]["doubleSided"])
        self.assertTrue(before.endswith(after[20 + length:]))


if __name__ == "__main__":
    unittest.main()
