// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/traversal_leaks.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace petzval::apps {
namespace {

using test::diffuse_material;
using test::place;
using test::sphere;

Scene sphere_with_hole(float radius, bool hole) {
    Scene scene;
    Mesh mesh = sphere(V3f(0.2f, 1.f, -3.f), radius, 24, false);
    if (hole) mesh.triangles.resize(mesh.triangles.size() / 2);
    place(scene, mesh, diffuse_material(0.5f));
    finish_scene(scene);
    return scene;
}

TEST(TraversalLeaks, RaysMeetAClosedSurfaceAndMissAMissingOne) {
    const Scene whole = sphere_with_hole(1.f, false), half = sphere_with_hole(1.f, true);
    const std::vector<Ray> rays = shared_edge_rays(whole, 4000, 1);
    EXPECT_EQ(rays.size(), 4000u);
    EXPECT_EQ(traversal_leaks(Bvh(whole, Traversal::Robust), rays), 0u);
    const size_t through = traversal_leaks(Bvh(half, Traversal::Robust), rays);
    EXPECT_GT(through, 1600u);  // half of the edges, those of the rim in part
    EXPECT_LT(through, 2400u);
}

TEST(TraversalLeaks, RaysEndBehindTheirEdge) {
    const Scene outer = sphere_with_hole(1.f, false), inner = sphere_with_hole(0.2f, false);
    const std::vector<Ray> rays = shared_edge_rays(outer, 1000, 2);
    EXPECT_EQ(traversal_leaks(Bvh(inner, Traversal::Robust), rays), 1000u);
}

TEST(TraversalLeaks, CutoutsHaveNone) {
    Scene scene;
    Material leaf = diffuse_material(0.5f);
    leaf.alpha_mode = AlphaMode::Mask;
    place(scene, sphere(V3f(0.f), 1.f, 12, false), leaf);
    finish_scene(scene);
    EXPECT_TRUE(shared_edge_rays(scene, 10, 1).empty());
}

}  // namespace
}  // namespace petzval::apps
