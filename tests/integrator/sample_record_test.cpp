// SPDX-License-Identifier: Apache-2.0
// Records of samples: what they say of scenes whose paths are known.
#include "integrator/render/sample_record.h"

#include <gtest/gtest.h>

#include "camera/models/thin_lens.h"
#include "tests/support/scenes.h"

namespace petzval::integrator {
namespace {

using test::diffuse_material;
using test::emitter_material;
using test::glass_material;
using test::place;
using test::quad;

constexpr float kCamera_m = 5;

Mesh lit_sheet(float z) {
    return quad(V3f(-1, -1.5f, z), V3f(2, 0, 0), V3f(0, 3, 0));
}

/// A scene that a camera looks down on, onto the origin.
struct Below : test::World {
    PathOptions options;

    /// Samples of the one pixel.
    [[nodiscard]] SampleRecord sample(uint32_t index = 0) {
        if (!bvh) finish();
        camera::ThinLens lens;
        lens.to_world = M44f();
        lens.to_world.setTranslation(V3f(0, 0, kCamera_m));
        lens.yfov_rad = 0.01f;
        lens.aspect = 1;
        const RenderJob job;
        return SampleRecord::of(scene, *bvh, *lights, options, camera::ThinLensCamera(lens), job,
                                {1, 1}, {0, 0, index});
    }
    [[nodiscard]] const Material* material(size_t i) const { return &scene.materials[i]; }
};

/// Events of one kind.
std::vector<PathEvent> all(const SampleRecord& sample, PathStep step) {
    std::vector<PathEvent> out;
    for (const PathEvent& event : sample.events)
        if (event.step == step) out.push_back(event);
    return out;
}

TEST(SampleRecord, LightThatArrivesAndLightThatIsBlocked) {
    for (const bool blocked : {false, true}) {
        Below world;
        place(world.scene, lit_sheet(0), diffuse_material(0.5f));
        if (blocked)
            place(world.scene, quad(V3f(0.4f, -1, 0.8f), V3f(0.2f, 0, 0), V3f(0, 2, 0)),
                  diffuse_material(0.5f));
        world.scene.lights.push_back(PointLight{V3f(1, 0, 2), Rgb(1.f)});
        const SampleRecord sample = world.sample();
        ASSERT_EQ(sample.rays.size(), 1u);
        EXPECT_FALSE(sample.rays[0].to_target);
        const RenderJob job;
        const Sampler sampler(job.sampler, job.seed, {0, 0, 0});
        const V2f film = V2f(0.5f) + job.filter.sample(sampler.get2(Dim::Film));
        EXPECT_NEAR((sample.point_px - film).length(), 0, 1e-6);
        const auto begins = all(sample, PathStep::Begins), meets = all(sample, PathStep::Meets);
        ASSERT_EQ(begins.size(), 1u);
        EXPECT_EQ(begins[0].ray.origin, V3f(0, 0, kCamera_m));
        EXPECT_EQ(begins[0].lanes[1], sample.rays[0].weight[1]);
        ASSERT_GE(meets.size(), 1u);
        EXPECT_EQ(meets[0].surface->material, world.material(0));
        EXPECT_TRUE(meets[0].surface->front);
        EXPECT_NEAR(meets[0].number, kCamera_m, 1e-3);
        EXPECT_EQ(meets[0].lanes[1], 1);
        const auto draws = all(sample, PathStep::DrawsLight),
                   rays = all(sample, PathStep::ShadowRay), blocks = all(sample, PathStep::Blocks),
                   lit = all(sample, PathStep::Scatters);
        ASSERT_GE(draws.size(), 1u);
        EXPECT_EQ(draws[0].light, 0u);
        ASSERT_GE(rays.size(), 1u);
        EXPECT_EQ(rays[0].number, blocked ? 0 : 1);
        ASSERT_GE(blocks.size(), blocked ? 1u : 0u);
        if (blocked) {
            EXPECT_EQ(blocks[0].surface->material, world.material(1));
            EXPECT_NEAR(blocks[0].number, 0.4 * std::sqrt(5.), 0.1);
        }
        // Lambert's law: albedo / pi * intensity * cosine / distance^2.
        const double expected = blocked ? 0 : 0.5 / M_PI * (2 / std::sqrt(5.)) / 5;
        ASSERT_GE(lit.size(), 1u);
        EXPECT_NEAR(lit[0].lanes[0], expected, 0.05 * expected);
        EXPECT_GE(sample.film.x, lit[0].lanes[0] * sample.rays[0].weight[0]);
        EXPECT_EQ(sample.film.w, 1);
        EXPECT_FALSE(sample.left_out);
        const auto on = all(sample, PathStep::GoesOn);
        ASSERT_GE(on.size(), 1u);
        EXPECT_FALSE(on[0].drawn.delta || on[0].drawn.transmitted || on[0].straight);
    }
}

// The light of the steps adds up to the sample, and distances run from place to place.
TEST(SampleRecord, StepsAddUp) {
    Below world;
    place(world.scene, lit_sheet(0), emitter_material(0.25f, 0.8f));
    place(world.scene, quad(V3f(-9, -9, 8), V3f(0, 18, 0), V3f(18, 0, 0)), diffuse_material(0.5f));
    world.scene.sky = Sky::uniform(Rgb(0.5f, 1, 2));
    world.scene.lights.push_back(PointLight{V3f(0, 1, 3), Rgb(3.f)});
    world.finish();
    bool roulette = false, several = false;
    for (uint32_t i = 0; i < 64; ++i) {
        const SampleRecord sample = world.sample(i);
        f4 sum{};
        V3f from(0.f);
        for (const PathEvent& event : sample.events) {
            if (event.step == PathStep::Begins) from = event.ray.origin;
            if (event.step == PathStep::Shines || event.step == PathStep::Scatters ||
                event.step == PathStep::Sky)
                sum += event.lanes;
            if (event.step == PathStep::Meets) {
                EXPECT_EQ(event.number, (event.surface->p - from).length());
                from = event.surface->p;
            }
            if (event.step == PathStep::Roulette) {
                roulette = true;
                EXPECT_TRUE(event.number > 0 && event.number <= 1);
            }
        }
        several = several || all(sample, PathStep::Meets).size() > 1;
        EXPECT_EQ(all(sample, PathStep::Shines).at(0).lanes[2], 0.25f);
        sum *= sample.rays[0].weight;
        EXPECT_EQ(sum[0], sample.film.x) << i;
        EXPECT_EQ(sum[1], sample.film.y) << i;
        EXPECT_EQ(sum[2], sample.film.z) << i;
        for (const PathEvent& sky : all(sample, PathStep::Sky)) EXPECT_GT(sky.lanes[0], 0) << i;
    }
    EXPECT_TRUE(roulette && several);
}

TEST(SampleRecord, GlassIsRefractedAndPanesAreStraight) {
    for (const bool solid : {false, true}) {
        Below world;
        Material glass = glass_material(1.5f);
        glass.has_volume = solid;
        place(world.scene, test::sphere(V3f(0.f), 1, 32, true), glass);
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        bool through = false, mirrored = false;
        for (uint32_t i = 0; i < 64; ++i) {
            const SampleRecord sample = world.sample(i);
            EXPECT_TRUE(all(sample, PathStep::DrawsLight).empty()) << "clear glass samples none";
            for (const PathEvent& event : all(sample, PathStep::Meets))
                EXPECT_EQ(event.medium != nullptr, solid && !event.surface->front);
            for (const PathEvent& event : all(sample, PathStep::GoesOn)) {
                ASSERT_TRUE(event.drawn.delta);
                EXPECT_EQ(event.straight, event.drawn.transmitted && !solid);
                (event.drawn.transmitted ? through : mirrored) = true;
            }
        }
        EXPECT_TRUE(through && mirrored) << solid;
    }
}

// What a ray passes without meeting it: holes on the way to a surface, and on the way out.
TEST(SampleRecord, HolesOnTheWay) {
    for (const bool floor : {false, true}) {
        Below world;
        Material net = diffuse_material(0.5f);
        net.alpha_mode = AlphaMode::Mask;
        net.alpha = 0.2f;
        place(world.scene, lit_sheet(-1), floor ? diffuse_material(0.5f) : net);
        place(world.scene, lit_sheet(1), net);
        place(world.scene, lit_sheet(kCamera_m + 1), net);  // behind the camera
        if (floor) place(world.scene, lit_sheet(-2), net);  // and behind the floor
        world.options.max_depth = 0;
        const SampleRecord sample = world.sample();
        EXPECT_EQ(all(sample, PathStep::Meets).size(), floor ? 1u : 0u);
        EXPECT_EQ(sample.events.back().step, floor ? PathStep::MaxDepth : PathStep::Sky);
        const auto holes = all(sample, PathStep::Hole);
        ASSERT_EQ(holes.size(), floor ? 1u : 2u);
        EXPECT_EQ(holes[0].surface->material, world.material(1));
        EXPECT_NEAR(holes[0].surface->p.z, 1, 1e-5);
        EXPECT_NEAR(holes[0].number, kCamera_m - 1, 1e-3);
        EXPECT_EQ(sample.events[1].step, PathStep::Hole);
    }
}

// A pane lets the shadow ray through: it is no blocker.
TEST(SampleRecord, PanesBlockNothing) {
    Below world;
    Material pane = glass_material(1.5f);
    pane.has_volume = false;
    place(world.scene, lit_sheet(0), diffuse_material(0.5f));
    place(world.scene, quad(V3f(0.4f, -1, 0.8f), V3f(0.2f, 0, 0), V3f(0, 2, 0)), pane);
    world.scene.lights.push_back(PointLight{V3f(1, 0, 2), Rgb(1.f)});
    const SampleRecord sample = world.sample();
    EXPECT_EQ(all(sample, PathStep::ShadowRay).at(0).number, 1);
    EXPECT_TRUE(all(sample, PathStep::Blocks).empty());
    EXPECT_GT(all(sample, PathStep::Scatters).at(0).lanes[0], 0);
}

TEST(SampleRecord, BacksArePassed) {
    Below world;
    Material single = diffuse_material(0.5f);
    single.double_sided = false;
    place(world.scene, quad(V3f(-1, -1, 1), V3f(0, 3, 0), V3f(2, 0, 0)), single);
    place(world.scene, lit_sheet(0), diffuse_material(0.5f));
    const SampleRecord sample = world.sample();
    const auto culled = all(sample, PathStep::Culled), meets = all(sample, PathStep::Meets);
    ASSERT_EQ(culled.size(), 1u);
    EXPECT_FALSE(culled[0].surface->front);
    EXPECT_EQ(meets.at(0).surface->material, world.material(1));
    EXPECT_NEAR(meets[0].number, 1, 1e-3);
}

TEST(SampleRecord, WhyAPathEnds) {
    const auto end = [](const Material& m, const auto& change) {
        Below world;
        place(world.scene, lit_sheet(0), m);
        change(world);
        return world.sample().events.back().step;
    };
    const auto nothing = [](Below&) {};
    const Material matt = diffuse_material(0.5f);
    EXPECT_EQ(end(matt, [](Below& w) { w.options.max_depth = 0; }), PathStep::MaxDepth);
    EXPECT_EQ(end(diffuse_material(0.f), nothing), PathStep::Absorbed);
    EXPECT_EQ(end(matt, nothing), PathStep::Sky);
    Material unlit = matt;
    unlit.unlit = true;
    EXPECT_EQ(end(unlit, nothing), PathStep::Unlit);
    EXPECT_EQ(end(glass_material(1.5f), [](Below& w) { w.options.max_specular_depth = 0; }),
              PathStep::MaxClearDepth);
    // A dark body: what goes in meets its other side with nothing left.
    const auto put_dark = [](Below& w) {
        Material dark = glass_material(1.f, 0.f);
        dark.attenuation_distance_m = 1e-3f;
        place(w.scene, test::box(V3f(-0.9f, -0.9f, 1), V3f(0.9f, 0.9f, 2)), dark);
    };
    EXPECT_EQ(end(matt, put_dark), PathStep::Shines);
    // Roulette: by far most paths that have lost so much.
    EXPECT_EQ(end(diffuse_material(1e-6f), [](Below& w) { w.options.roulette_depth = 0; }),
              PathStep::Roulette);
}

// Two bodies that overlap: at the inner face of the one that counts less nothing changes.
TEST(SampleRecord, HiddenFacesAreToldOf) {
    Below world;
    place(world.scene, test::box(V3f(-0.5f, -0.6f, 0), V3f(0.6f, 0.5f, 2)), glass_material(1.5f));
    place(world.scene, test::box(V3f(-0.6f, -0.7f, -1), V3f(0.7f, 0.6f, 1)), glass_material(1.3f));
    world.finish();
    bool hidden = false;
    for (uint32_t i = 0; i < 16; ++i)
        hidden = hidden || !all(world.sample(i), PathStep::Hidden).empty();
    EXPECT_TRUE(hidden);
}

}  // namespace
}  // namespace petzval::integrator
