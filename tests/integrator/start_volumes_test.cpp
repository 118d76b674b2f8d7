// SPDX-License-Identifier: Apache-2.0
// Which volumes hold a point.
#include "integrator/path/start_volumes.h"

#include <gtest/gtest.h>

#include "core/sampling/sampler.h"
#include "tests/support/scenes.h"

namespace petzval::integrator {
namespace {

using test::box;
using test::glass_material;
using test::place;
using test::sphere;
using test::World;

TEST(NestedVolumes, VolumesAtAPointAreThoseThatHoldIt) {
    World world;
    place(world.scene, sphere(V3f(0), 2, 24, false), glass_material(1.5f));
    place(world.scene, box(V3f(-1), V3f(1)), glass_material(1.3f));
    place(world.scene, box(V3f(0), V3f(5)), glass_material(1.3f));
    world.finish();
    for (uint32_t i = 0; i < 2000; ++i) {
        const Sampler s(SamplerKind::Independent, 7, {1, 2, i});
        const V2f a = s.get2(Dim::Film);
        const V3f p(8 * a.x - 3, 8 * a.y - 3, 8 * s.get1(Dim::TargetRest) - 3);
        if (std::fabs(p.length() - 2) < 0.1f) continue;  // facets
        const auto in_box = [&](float lo, float hi) {
            for (int k = 0; k < 3; ++k)
                if (p[k] < lo || p[k] > hi) return false;
            return true;
        };
        Volumes due;
        if (p.length() < 2) due.add(world.scene.materials[0], 1);
        if (in_box(-1, 1)) due.add(world.scene.materials[1], 1);
        if (in_box(0, 5)) due.add(world.scene.materials[2], 1);
        EXPECT_TRUE(volumes_at(world.scene, *world.bvh, p) == due) << p;
    }
}

// Sees no hits in one of three directions, as if it had slipped through a seam.
struct Leaky {
    const Bvh& bvh;
    size_t leaks;
    mutable size_t asked = 0;
    [[nodiscard]] std::vector<Hit> all_hits(const Ray& ray) const {
        return asked++ % 3 == leaks ? std::vector<Hit>() : bvh.all_hits(ray);
    }
};

TEST(NestedVolumes, OneRayThatSlipsThroughASeamDoesNotDecide) {
    World world;
    place(world.scene, sphere(V3f(0), 2, 24, false), glass_material(1.5f));
    place(world.scene, box(V3f(-1), V3f(1)), glass_material(1.3f));
    world.finish();
    Volumes due;
    for (const Material& m : world.scene.materials) due.add(m, 1);
    for (size_t leaks = 0; leaks < 3; ++leaks)
        EXPECT_TRUE(volumes_at(world.scene, Leaky{*world.bvh, leaks}, V3f(0.1f)) == due) << leaks;
}

}  // namespace
}  // namespace petzval::integrator
