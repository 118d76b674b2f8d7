// SPDX-License-Identifier: Apache-2.0
// Pictures with motion blur against the mean of stills at stratified times, pixel by pixel.
#include <gtest/gtest.h>

#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "camera/targets/target_grid.h"
#include "core/scene/lamp.h"
#include "tests/support/blurred.h"
#include "tests/support/lens_cameras.h"

namespace petzval::apps {
namespace {

using namespace test;

std::unique_ptr<camera::Camera> pinhole(const M44f& to_world) {
    camera::ThinLens lens;
    lens.to_world = to_world;
    lens.yfov_rad = 0.8f;
    lens.aspect = 4.f / 3;
    return std::make_unique<camera::ThinLensCamera>(lens);
}

std::unique_ptr<camera::Camera> thin_lens(const M44f& to_world) {
    camera::ThinLens lens;
    lens.to_world = to_world;
    lens.yfov_rad = 0.8f;
    lens.aspect = 1;
    lens.iris = camera::Iris(camera::Disk{}, 60);
    lens.focus_m = 3;
    return std::make_unique<camera::ThinLensCamera>(lens);
}

std::unique_ptr<camera::Camera> traced_lens(const M44f& to_world) {
    camera::LensCameraInput in = input_of(kGauss, camera::DispersionMode::Shared);
    in.to_world = to_world;
    return std::make_unique<camera::LensCamera>(in);
}

const M44f kStand = camera::look_at(V3f(0, 0.6f, 4), V3f(0, 0.3f, 0));

/// A floor, a wall, and a lamp at a point.
Motion room() {
    Motion motion;
    motion.camera = pinhole;
    motion.camera_steps = {kStand};
    motion.options.max_depth = 3;
    place(motion.scene, quad(V3f(-4, 0, -2), V3f(0, 0, 5), V3f(8, 0, 0)), diffuse_material(0.6f));
    place(motion.scene, quad(V3f(-4, 0, -2), V3f(8, 0, 0), V3f(0, 4, 0)), diffuse_material(0.7f));
    return motion;
}

Motion lit_room() {
    Motion motion = room();
    motion.scene.lights = {PointLight{V3f(1, 2.5f, 2), Rgb(20.f)}};
    return motion;
}

void expect_bands_mean_of_stills(const Motion& motion, uint32_t spp = 96) {
    const auto camera = shuttered(motion);
    EXPECT_TRUE(same_picture(blurred(motion, *camera, spp), of_stills(motion, spp / kStills)));
}

M44f swings(float time) {
    return turned(V3f(0, 0, 2.5f * time), V3f(0.8f * time - 0.4f, 0.9f, 0.2f), V3f(1, 1.3f, 1));
}

TEST(MotionBlur, OfATurningThingAndItsShadow) {
    Motion motion = lit_room();
    place_moving(motion.scene, box(V3f(-0.9f, -0.15f, -0.1f), V3f(0.9f, 0.15f, 0.1f)),
                 diffuse_material(0.8f), at_steps(9, swings));
    expect_bands_mean_of_stills(motion);
}

TEST(MotionBlur, OfAThingThatDeforms) {
    Motion motion = lit_room();
    Mesh soft = sphere(V3f(0, 0.7f, 0), 0.6f, 8, true);
    deform(
        soft, 5,
        [](const V3f& p, float time) {
            return V3f(p.x + time * p.y, p.y * (1.2f - 0.8f * time), p.z);
        },
        [](const V3f& n, float time) { return unit(n + V3f(0, 0, 0.8f * time)); });
    place(motion.scene, soft, diffuse_material(0.8f));
    expect_bands_mean_of_stills(motion);
}

TEST(MotionBlur, OfAThingThatDeformsOnItsFlight) {
    Motion motion = lit_room();
    motion.curve = {{{0, 1}, {0.3f, 0.2f}, {0.3f, 0}, {1, 1}}};
    Mesh soft = sphere(V3f(0.f), 0.5f, 8, true);
    deform(soft, 3, [](const V3f& p, float time) { return p * (0.5f + time); });
    place_moving(motion.scene, soft, diffuse_material(0.8f), at_steps(9, swings));
    place_moving(motion.scene, 2, at_steps(2, [](float time) {
                     return turned(V3f(0.f), V3f(-1.2f, 0.3f + time, 0.5f), V3f(-0.7f, 0.7f, 0.7f));
                 }));
    expect_bands_mean_of_stills(motion);
}

// A lamp that grows and turns its one bright side away, by all ways to its light.
TEST(MotionBlur, OfALampByEveryTechnique) {
    for (const integrator::Technique technique :
         {integrator::Technique::Mis, integrator::Technique::LightOnly,
          integrator::Technique::BsdfOnly}) {
        Motion motion = room();
        motion.options.technique = technique;
        Material lamp = emitter_material(12.f);
        lamp.double_sided = false;
        place_moving(motion.scene, quad(V3f(-0.7f, 0, -0.7f), V3f(1.4f, 0, 0), V3f(0, 0, 1.4f)),
                     lamp, at_steps(17, [](float time) {
                         return turned(V3f(0.3f, 0, 3 * time), V3f(2 * time - 1, 1.2f, 0),
                                       V3f(0.3f + 1.4f * time));
                     }));
        expect_bands_mean_of_stills(motion,
                                    technique == integrator::Technique::BsdfOnly ? 192 : 96);
    }
}

// Many lamps, so that a tree chooses among them.
TEST(MotionBlur, OfManyLamps) {
    Motion motion = room();
    const Mesh one = quad(V3f(-0.1f, 0, -0.1f), V3f(0.2f, 0, 0), V3f(0, 0, 0.2f));
    for (int i = 0; i < 12; ++i) {
        Material lamp = emitter_material(60.f);
        lamp.double_sided = i % 3 == 0;
        place_moving(motion.scene, one, lamp, at_steps(9, [&](float time) {
                         return turned(V3f(float(i), 0, 4 * time),
                                       V3f(0.4f * float(i) - 2.2f, 0.2f + time, float(i % 4) - 2));
                     }));
    }
    expect_bands_mean_of_stills(motion);
}

TEST(MotionBlur, OfPointAndSpotLightsAndSuns) {
    Motion motion = room();
    place(motion.scene, box(V3f(-0.3f, 0, -0.3f), V3f(0.3f, 0.8f, 0.3f)), diffuse_material(0.5f));
    const auto add_moving = [&](auto light_at_time) {
        motion.scene.light_motion_of.push_back(int32_t(motion.scene.light_motions.size()));
        motion.scene.light_motions.push_back(at_steps(9, light_at_time));
        motion.scene.lights.push_back(light_at_time(0.5f));
    };
    add_moving([](float time) -> Light {
        return PointLight{V3f(3 * time - 1.5f, 1.5f, 0.8f), Rgb(4.f)};
    });
    add_moving([](float time) -> Light {
        return SpotLight{V3f(0, 3, 1), unit(V3f(time - 0.5f, -1, -time)), Rgb(30.f), 0.97f, 0.9f};
    });
    add_moving([](float time) -> Light {
        return SunLight{unit(V3f(time - 0.2f, -1, -0.4f)), Rgb(1.f)};
    });
    expect_bands_mean_of_stills(motion);
}

TEST(MotionBlur, OfBallsThatShine) {
    Motion motion = room();
    std::vector<BallLamp> balls(2);
    const auto flight = [](float time) { return V3f(2 * time - 1, 0.5f + time, 0.3f); };
    balls[0] = {flight(0.5f), 0.15f, Rgb(4.f), -1, {}, at_steps(5, flight)};
    const auto back = [](float time) { return V3f(1.5f - 3 * time, 2.5f, -1); };
    balls[1] = {back(0.5f),       0.1f, Rgb(30.f), -1, Beam{V3f(0, -1, 0), 0.95f, 0.8f},
                at_steps(2, back)};
    add_lamps(motion.scene, balls);
    motion.options.max_depth = 2;
    expect_bands_mean_of_stills(motion);
}

std::vector<M44f> camera_flight() {
    return at_steps(9, [](float time) {
        return turned(V3f(-0.1f, 0.25f * time - 0.1f, 0.2f * time),
                      V3f(time - 0.5f, 0.6f, 4 - 0.8f * time));
    });
}

TEST(MotionBlur, OfACameraThatMoves) {
    for (const auto& camera : {pinhole, thin_lens, traced_lens}) {
        Motion motion = lit_room();
        motion.camera = camera;
        motion.camera_steps = camera_flight();
        motion.curve = {{{0, 0}, {0.2f, 1}, {1, 0.2f}}};
        place(motion.scene, box(V3f(-0.5f, 0, -0.5f), V3f(0.5f, 1, 0.5f)), diffuse_material(0.3f));
        place_moving(motion.scene, box(V3f(-0.2f), V3f(0.2f)), emitter_material(3.f),
                     at_steps(3, swings));
        expect_bands_mean_of_stills(motion);
    }
}

/// Focused before what it shows, so that rays of a pixel go far apart.
std::unique_ptr<camera::Camera> blurring_lens(const M44f& to_world) {
    camera::ThinLens lens;
    lens.to_world = to_world;
    lens.yfov_rad = 0.5f;
    lens.aspect = 1;
    lens.iris = camera::Iris(camera::Disk{}, 60);
    lens.focus_m = 1.2f;
    return std::make_unique<camera::ThinLensCamera>(lens);
}

// Rays to a lamp that flies, and of a camera that moves away from where they were aimed.
TEST(MotionBlur, WithRaysToTargets) {
    for (const bool traced : {false, true}) {
        Motion motion = lit_room();
        motion.camera = traced ? traced_lens : blurring_lens;
        motion.size = V2i(16, 16);
        motion.camera_steps = at_steps(2, [](float time) {
            return camera::look_at(V3f(0.8f * time - 0.4f, 0.5f, 4),
                                   V3f(0.8f * time - 0.4f, 0.35f, 0));
        });
        const float size = traced ? 0.15f : 1;  // the traced lens blurs less
        place_moving(motion.scene, sphere(V3f(0.f), 0.03f * size, 6, true),
                     emitter_material(200.f / (size * size)), at_steps(5, [&](float time) {
                         return turned(V3f(0.f), V3f(0, 0.35f + 0.05f * size * time, 0));
                     }));
        Scene finished = motion.scene;
        finish_scene(finished);
        auto aims = camera::target_camera(middle_camera(motion));
        aims->set_targets(camera::find_targets(*aims, motion.size, small_features_of(finished)));
        ASSERT_NE(aims->targets(), nullptr) << traced;
        EXPECT_TRUE(same_picture(blurred(motion, *shuttered(motion, std::move(aims)), 96),
                                 of_stills(motion, 8)))
            << traced;
    }
}

/// Glass that colours what is behind it.
Material tinted_glass(float ior) {
    Material glass = glass_material(ior);
    glass.attenuation_color = Rgb(0.3f, 0.4f, 0.8f);
    glass.attenuation_distance_m = 0.5f;
    return glass;
}

TEST(MotionBlur, OfGlassThatFlies) {
    Motion motion = lit_room();
    motion.options.max_depth = 2;
    motion.scene.sky = Sky::uniform(Rgb(0.5f));
    place_moving(
        motion.scene, sphere(V3f(0.f), 0.6f, 10, true), tinted_glass(1.3f),
        at_steps(5, [](float time) { return turned(V3f(0.f), V3f(2 * time - 1, 0.9f, 0.4f)); }));
    expect_bands_mean_of_stills(motion);
}

// Glass that passes over the camera, elsewhere in the middle of the exposure, and a ball of another
// glass before the camera: what the path meets first does not tell where it began.
TEST(MotionBlur, OfACameraThatGlassPassesOver) {
    Motion motion = lit_room();
    motion.options.max_depth = 1;
    motion.scene.sky = Sky::uniform(Rgb(0.5f));
    place_moving(
        motion.scene, box(V3f(-0.9f), V3f(0.9f)), tinted_glass(1.4f),
        at_steps(5, [](float time) { return turned(V3f(0.f), V3f(4 * time, 0.7f, 4.1f)); }));
    place(motion.scene, sphere(V3f(0, 0.6f, 3.6f), 0.15f, 8, true), tinted_glass(1.2f));
    expect_bands_mean_of_stills(motion);
}

// One glass flies into another, from which it is apart in the middle of the exposure.
TEST(MotionBlur, OfGlassThatFliesIntoGlass) {
    Motion motion = lit_room();
    motion.options.max_depth = 1;
    motion.scene.sky = Sky::uniform(Rgb(0.5f));
    place(motion.scene, box(V3f(0, 0.1f, -0.6f), V3f(1.2f, 1.3f, 0.6f)), tinted_glass(1.2f));
    place_moving(
        motion.scene, box(V3f(-0.3f), V3f(0.3f)), tinted_glass(1.6f),
        at_steps(5, [](float time) { return turned(V3f(0.f), V3f(3 * time - 2.2f, 0.7f, 0)); }));
    expect_bands_mean_of_stills(motion);
}

// A drink in a glass that it touches, which turn together.
TEST(MotionBlur, OfADrinkInAGlass) {
    Motion motion = lit_room();
    motion.options.max_depth = 1;
    motion.scene.sky = Sky::uniform(Rgb(0.5f));
    const auto flight = at_steps(17, [](float time) {
        return turned(V3f(0.2f, 1.5f * time, 1.f * time), V3f(1.6f * time - 0.8f, 0.8f, 0));
    });
    place_moving(motion.scene, box(V3f(-0.5f, -0.5f, -0.4f), V3f(0.5f, 0.1f, 0.4f)),
                 tinted_glass(1.3f), flight);
    place_moving(motion.scene, box(V3f(-0.5f, 0.1f, -0.4f), V3f(0.5f, 0.5f, 0.4f)),
                 tinted_glass(1.6f), flight);
    expect_bands_mean_of_stills(motion);
}

// Few triangles with smooth normals, lit across their edges by lights that move.
TEST(MotionBlur, OfACoarseSmoothThing) {
    for (const bool point : {false, true}) {
        Motion motion = room();
        motion.options.max_depth = 1;
        const auto flight = [](float time) { return V3f(5 * time - 2.5f, 1.2f, 0.2f); };
        const auto steps = at_steps(9, [&](float time) { return turned(V3f(0.f), flight(time)); });
        if (point) {
            const auto light = [&](float time) -> Light {
                return PointLight{flight(time), Rgb(8.f)};
            };
            motion.scene.lights.push_back(light(0.5f));
            motion.scene.light_motion_of = {0};
            motion.scene.light_motions = {at_steps(9, light)};
        } else {
            place_moving(motion.scene, box(V3f(-0.1f), V3f(0.1f)), emitter_material(60.f), steps);
        }
        place(motion.scene, sphere(V3f(0, 0.8f, 0.6f), 0.9f, 3, true), diffuse_material(0.8f));
        motion.scene.materials.back().double_sided = false;
        expect_bands_mean_of_stills(motion, 192);
    }
}

TEST(MotionBlur, OfALeafThatIsPartlyThere) {
    for (const AlphaMode mode : {AlphaMode::Mask, AlphaMode::Blend}) {
        Motion motion = lit_room();
        Material leaf = diffuse_material(0.9f);
        leaf.alpha_mode = mode;
        leaf.alpha_cutoff = 0.5f;
        Mesh mesh = quad(V3f(-0.8f, -0.5f, 0), V3f(1.6f, 0, 0), V3f(0, 1, 0));
        for (const float alpha : {0.f, 1.f, 0.7f, 0.2f})
            mesh.colours.push_back(V4f(1, 1, 1, alpha));
        place_moving(motion.scene, mesh, leaf, at_steps(9, swings));
        expect_bands_mean_of_stills(motion);
    }
}

// A pane that is seen through, and that light passes on its way to the floor.
TEST(MotionBlur, OfAPane) {
    Motion motion = lit_room();
    Material pane = diffuse_material(0.4f);
    pane.roughness = 0;
    pane.transmission = 1;
    place_moving(motion.scene, quad(V3f(-0.7f, -0.4f, 0), V3f(1.4f, 0, 0), V3f(0, 0.8f, 0)), pane,
                 at_steps(9, swings));
    expect_bands_mean_of_stills(motion);
}

TEST(MotionBlur, GivesTheSameBytesForAnyThreadsAndTiles) {
    Motion motion = lit_room();
    motion.camera_steps = camera_flight();
    motion.size = V2i(24, 16);
    motion.curve = camera::ShutterCurve::trapezoid();
    Mesh soft = sphere(V3f(0.f), 0.5f, 8, true);
    deform(soft, 3, [](const V3f& p, float time) { return p * (0.5f + time); });
    place_moving(motion.scene, soft, emitter_material(2.f, 0.5f), at_steps(9, swings));
    const auto camera = shuttered(motion);
    const Renderer renderer(motion.scene, motion.options);
    const auto first = renderer(*camera, motion.size, 16, 5, 1, 16);
    for (const auto& [threads, tile] : {std::pair(1, 5), std::pair(2, 16), std::pair(3, 7)})
        EXPECT_EQ(renderer(*camera, motion.size, 16, 5, threads, tile), first) << threads;
}

// With a shutter that opens on a scene that stands still, nothing changes but the numbers drawn.
TEST(MotionBlur, OfNothingThatMovesIsTheStill) {
    Motion motion = lit_room();
    const auto open = shuttered(motion);
    const auto still = pinhole(kStand);
    const Renderer renderer(motion.scene, motion.options);
    EXPECT_EQ(renderer(*open, motion.size, 16, 5), renderer(*still, motion.size, 16, 5));
}

}  // namespace
}  // namespace petzval::apps
