// SPDX-License-Identifier: Apache-2.0
// A path at a time through what moves, against the same path through a still of that time: number
// by number, as both draw alike.
#include <gtest/gtest.h>

#include "core/scene/lamp.h"
#include "integrator/path/path.h"
#include "tests/support/blurred.h"

namespace petzval::integrator {
namespace {

using namespace test;

struct Tracing {
    Scene scene;
    std::unique_ptr<Bvh> bvh;
    std::unique_ptr<LightChoice> lights;
    std::unique_ptr<PathTracer<>> tracer;

    Tracing(Scene of, const PathOptions& options) : scene(std::move(of)) {
        finish_scene(scene);
        bvh = std::make_unique<Bvh>(scene, Traversal::Robust);
        // Chances that know nothing of where lights are, and so not of when.
        lights = std::make_unique<LightChoice>(scene, LightChoiceKind::Uniform);
        tracer = std::make_unique<PathTracer<>>(scene, *bvh, *lights, options);
    }
    [[nodiscard]] float radiance(const Ray& ray, uint32_t index) const {
        FilmSample out;
        PathStats stats;
        const Sampler sampler(SamplerKind::Owen, 3, {0, 0, index});
        return tracer->radiance({ray}, Bands::rgb(), sampler, out, stats)[1];
    }
};

/// Rays into a scene around the origin; few may differ, where rounding decides what they meet.
void expect_paths_of_stills(const Scene& moving, PathOptions options = {}) {
    options.max_depth = 3;
    for (const Technique technique : {Technique::Mis, Technique::LightOnly}) {
        options.technique = technique;
        const Tracing open(moving, options);
        for (const float time : {0.f, 0.21f, 0.83f, 1.f}) {
            const Tracing still(frozen(moving, double(time)), options);
            Random random(5);
            int differing = 0, bright = 0;
            constexpr uint32_t kRays = 2000;
            for (uint32_t i = 0; i < kRays; ++i) {
                Ray ray;
                ray.origin = V3f(2 * random.next() - 1, 0.2f + 1.5f * random.next(), 3);
                ray.direction =
                    unit(V3f(2 * random.next() - 1, 1.5f * random.next(), 0) - ray.origin);
                Ray at_time = ray;
                at_time.time = time;
                const float expected = still.radiance(ray, i), found = open.radiance(at_time, i);
                bright += expected > 0;
                differing += std::fabs(found - expected) > 2e-3f * expected + 1e-5f;
            }
            EXPECT_LE(differing, 20) << "at " << time;
            EXPECT_GT(bright, 200) << "at " << time;
        }
    }
}

/// A floor and a wall.
Scene moving_room() {
    Scene scene;
    place(scene, quad(V3f(-4, 0, -2), V3f(0, 0, 6), V3f(8, 0, 0)), diffuse_material(0.6f));
    place(scene, quad(V3f(-4, 0, -2), V3f(8, 0, 0), V3f(0, 4, 0)), diffuse_material(0.7f));
    return scene;
}

void add_light(Scene& scene) {
    const auto light = [](float time) -> Light {
        return PointLight{V3f(4 * time - 2, 2, 1.5f), Rgb(10.f)};
    };
    scene.light_motion_of = {0};
    scene.light_motions = {at_steps(3, light)};
    scene.lights = {light(0.5f)};
}

M44f flies(float time) {
    return turned(V3f(0.3f, 0, 2 * time), V3f(1.6f * time - 0.8f, 0.9f, 0.2f));
}

TEST(MotionPath, OfLampsThatGrowAndTurn) {
    Scene scene = moving_room();
    Material lamp = emitter_material(9.f, 0.3f);
    lamp.double_sided = false;
    place_moving(scene, box(V3f(-0.3f), V3f(0.3f)), lamp, at_steps(9, [](float time) {
                     return turned(V3f(time, 0, 2 * time), V3f(time - 0.5f, 1, 0),
                                   V3f(0.5f + time, 0.5f + time, 1));
                 }));
    Mesh soft = quad(V3f(-1, 2, -1), V3f(0.5f, 0, 0), V3f(0, 0, 0.5f));
    deform(soft, 3, [](const V3f& p, float time) { return p * (0.4f + time); });
    place(scene, soft, emitter_material(9.f));
    expect_paths_of_stills(scene);
}

TEST(MotionPath, OfCoarseSmoothThingsInLightThatMoves) {
    Scene scene = moving_room();
    add_light(scene);
    place_moving(
        scene, box(V3f(-0.1f), V3f(0.1f)), emitter_material(60.f),
        at_steps(5, [](float time) { return turned(V3f(0.f), V3f(3 - 6 * time, 0.8f, 0.6f)); }));
    Material matt = diffuse_material(0.8f);
    matt.double_sided = false;
    Mesh ball = sphere(V3f(0, 0.8f, 0.3f), 0.8f, 3, true);
    deform(ball, 3, [](const V3f& p, float time) { return p * (0.7f + 0.5f * time); });
    place(scene, ball, matt);
    place_moving(scene, sphere(V3f(0.f), 0.5f, 3, true), matt, at_steps(9, flies));
    expect_paths_of_stills(scene);
}

Material tinted_glass(float ior, float roughness = 0) {
    Material glass = glass_material(ior, 0.5f);
    glass.roughness = roughness;
    return glass;
}

TEST(MotionPath, OfAGlassWithADrinkThatTurnTogether) {
    for (const float roughness : {0.f, 0.4f}) {
        Scene scene = moving_room();
        add_light(scene);
        scene.sky = Sky::uniform(Rgb(0.5f));
        const auto flight = at_steps(9, flies);
        place_moving(scene, box(V3f(-0.5f, -0.5f, -0.4f), V3f(0.5f, 0.1f, 0.4f)),
                     tinted_glass(1.3f, roughness), flight);
        place_moving(scene, box(V3f(-0.5f, 0.1f, -0.4f), V3f(0.5f, 0.5f, 0.4f)),
                     tinted_glass(1.6f, roughness), flight);
        expect_paths_of_stills(scene);
    }
}

TEST(MotionPath, OfPanesAndLeaves) {
    Scene scene = moving_room();
    add_light(scene);
    Material pane = diffuse_material(0.4f), leaf = diffuse_material(0.9f);
    pane.roughness = 0;
    pane.transmission = 1;
    leaf.alpha_mode = AlphaMode::Blend;
    leaf.alpha = 0.5f;
    const Mesh sheet = quad(V3f(-0.7f, -0.4f, 0), V3f(1.4f, 0, 0), V3f(0, 0.8f, 0));
    place_moving(scene, sheet, pane, at_steps(9, flies));
    place_moving(scene, sheet, leaf, at_steps(3, [](float time) {
                     return turned(V3f(0, time, 0), V3f(0.5f - time, 0.5f, 0.7f));
                 }));
    expect_paths_of_stills(scene);
}

// A normal map on what turns, is mirrored on its way, and bends.
TEST(MotionPath, OfMappedNormals) {
    Scene scene = moving_room();
    add_light(scene);
    Material mapped = diffuse_material(0.9f);
    mapped.normal_texture.image = 0;
    scene.images.push_back({"", 1, 1, std::vector<uint8_t>{204, 100, 230, 255}});
    Mesh sheet = quad(V3f(-0.7f, -0.5f, 0), V3f(1.4f, 0, 0), V3f(0, 1, 0));
    sheet.normals.assign(4, V3f(0, 0, 1));
    sheet.tangents.assign(4, V4f(1, 0, 0, 1));
    place_moving(scene, sheet, mapped, at_steps(4, [](float time) {
                     return turned(V3f(0.3f, 0.5f * time, 2 * time), V3f(-0.5f, 0.8f, 0.2f),
                                   V3f(1 - 1.7f * time, 1, 1));
                 }));
    Mesh soft = sheet;
    deform(soft, 3,
           [](const V3f& p, float time) { return V3f(p.x + 0.6f, p.y + 0.8f, 0.5f + p.x * time); });
    for (size_t i = 0; i < 3; ++i) soft.steps[i].tangents.assign(4, V4f(1, float(i), 0.4f * i, 1));
    place(scene, soft, mapped);
    expect_paths_of_stills(scene);
}

}  // namespace
}  // namespace petzval::integrator
