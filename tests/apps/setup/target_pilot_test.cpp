// SPDX-License-Identifier: Apache-2.0
// Which targets the pilot keeps, and how often rays are sent to each.
#include "integrator/prepass/target_pilot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "camera/targets/target_grid.h"
#include "integrator/prepass/highlights.h"
#include "tests/support/scenes.h"
#include "tests/support/targets.h"

namespace petzval::apps {
namespace {

using namespace test;

const V2i kPilot_px(128, 96);
constexpr float kFar_m = 3;

/// Two lamps whose discs overlap, and are a cell wide.
const V3f kOne(0.02f, 0.05f, -kFar_m), kOther(0.08f, 0.05f, -kFar_m);

camera::ThinLensCamera wide_lens(float focus_m) {
    camera::ThinLens lens;
    lens.to_world = camera::look_at(V3f(0, 0, 0), V3f(0, 0, -1));
    lens.yfov_rad = 0.3f;
    lens.aspect = 4.f / 3;
    lens.iris = camera::Iris(camera::Disk{}, 50);
    lens.focus_m = focus_m;
    return camera::ThinLensCamera(lens);
}

void place_lamp(Scene& scene, const V3f& at, float nits) {
    place(scene, sphere(at, 0.004f, 8, true), emitter_material(nits));
}
void place_wall(Scene& scene) {
    place(scene, quad(V3f(-2, -2, -4), V3f(4, 0, 0), V3f(0, 4, 0)), diffuse_material(0.5f));
}
/// So near to a lamp that no point of the lens sees it, and so small that it hides no other.
void hide(Scene& scene, const V3f& lamp) {
    place(scene, quad(lamp + V3f(-.01f, -.01f, .02f), V3f(.02f, 0, 0), V3f(0, .02f, 0)),
          diffuse_material(0.5f));
}

struct Grids {
    std::shared_ptr<const camera::TargetGrid> all, paying;
};
Grids grids_of(World& world, const camera::RunTasks& run = camera::one_by_one, float focus_m = 1) {
    world.finish();
    const auto still = std::make_shared<camera::ThinLensCamera>(wide_lens(focus_m));
    const auto camera = camera::target_camera(still);
    std::vector<SmallFeature> features = small_features_of(world.scene, 1024);
    for (const SmallFeature& image :
         integrator::highlights(*still, world.scene, *world.bvh, kPilot_px, features, run))
        features.push_back(image);
    camera->set_targets(camera::find_targets(*camera, kPilot_px, features, run));
    return {camera->targets(), integrator::targets_that_pay(*camera, world.scene, *world.bvh,
                                                            *world.lights, kPilot_px, run)};
}

bool is_at(const camera::TargetGrid& grid, const camera::ListedTarget& listed, const V3f& lamp) {
    return (grid.targets[listed.number].centre - lamp).length() < 1e-3f;
}
size_t cells_with(const camera::TargetGrid& grid, const V3f& lamp) {
    return static_cast<size_t>(
        std::count_if(grid.lists.begin(), grid.lists.end(), [&](const auto& list) {
            return std::any_of(list.targets.begin(), list.targets.end(),
                               [&](const camera::ListedTarget& t) { return is_at(grid, t, lamp); });
        }));
}

/// Each of a cell's targets is one of those that were found for it, chances add up to 1, and none
/// has less than a share of what it would have if all had the same.
void expect_sane(const Grids& grids, float least_share = 0.5f) {
    ASSERT_EQ(grids.paying->lists.size(), grids.all->lists.size());
    for (size_t i = 0; i < grids.all->lists.size(); ++i) {
        std::set<uint32_t> found, kept;
        for (const camera::ListedTarget& t : grids.all->lists[i].targets) found.insert(t.number);
        double sum = 0;
        const auto& list = grids.paying->lists[i].targets;
        for (const camera::ListedTarget& t : list) {
            EXPECT_TRUE(kept.insert(t.number).second) << "twice in cell " << i;
            EXPECT_TRUE(found.count(t.number)) << "not of cell " << i;
            EXPECT_GE(t.chance, least_share / float(list.size()) - 1e-6f);
            sum += double(t.chance);
        }
        if (list.empty()) continue;
        EXPECT_NEAR(sum, 1, 1e-6) << "cell " << i;
        EXPECT_TRUE(grids.paying->lists[i].map) << "cell " << i;
        EXPECT_GE(grids.paying->lists[i].rays, 1u) << "cell " << i;
        EXPECT_LE(grids.paying->lists[i].rays, camera::TargetCell::kMostRays) << "cell " << i;
    }
}

// Half of the chances is even, half goes by what a ray brings: 4 to 1 is 0.65 to 0.35.
TEST(TargetPilot, BrightTargetsGetMoreRays) {
    World world;
    place_lamp(world.scene, kOne, 250);
    place_lamp(world.scene, kOther, 1000);
    place_wall(world.scene);
    const Grids grids = grids_of(world);
    ASSERT_NE(grids.paying, nullptr);
    expect_sane(grids);
    int both = 0;
    for (const camera::TargetCell& cell : grids.paying->lists) {
        if (cell.targets.size() != 2) continue;
        ++both;
        for (const camera::ListedTarget& t : cell.targets)
            EXPECT_NEAR(t.chance, is_at(*grids.paying, t, kOther) ? 0.65f : 0.35f, 0.12f);
    }
    EXPECT_GT(both, 0);
}

// Some cells have both lamps, some one of them: in no cell the hidden one is taken for the other.
TEST(TargetPilot, HiddenLampsAreLeftOut) {
    for (const bool first : {false, true}) {
        const V3f &hidden = first ? kOne : kOther, &seen = first ? kOther : kOne;
        World world;
        place_lamp(world.scene, hidden, 2000);
        place_lamp(world.scene, seen, 500);
        place_wall(world.scene);
        hide(world.scene, hidden);
        const Grids grids = grids_of(world);
        ASSERT_NE(grids.all, nullptr);
        ASSERT_GT(cells_with(*grids.all, hidden), 0u);
        ASSERT_NE(grids.paying, nullptr);
        expect_sane(grids);
        EXPECT_EQ(cells_with(*grids.paying, hidden), 0u);
        EXPECT_GT(cells_with(*grids.paying, seen), 0u);
    }
}

// A lamp that no ray gets to, and one that adds next to nothing to the noise of a wall that a large
// panel lights.
TEST(TargetPilot, NothingThatDoesNotPay) {
    for (const bool hidden : {false, true}) {
        World world;
        place_lamp(world.scene, kOne, hidden ? 2000 : 12);
        place_wall(world.scene);
        place(world.scene, quad(V3f(-3, -3, 1), V3f(6, 0, 0), V3f(0, 6, 0)), emitter_material(30));
        if (hidden) hide(world.scene, kOne);
        const Grids grids = grids_of(world);
        ASSERT_NE(grids.all, nullptr);
        EXPECT_EQ(grids.paying, nullptr);
    }
}

/// So many lamps, evenly over a rectangle of the view.
std::vector<V3f> place_lamps(Scene& scene, uint32_t count, float radius_m = 0.002f) {
    std::vector<V3f> out;
    for (uint32_t i = 0; i < count; ++i) {
        const V2f u = random2(i, 1);
        out.emplace_back((u.x - 0.5f) * 0.4f, (u.y - 0.5f) * 0.3f, -kFar_m);
        place(scene, sphere(out.back(), radius_m, 4, true), emitter_material(5000));
    }
    return out;
}

// Lamps in focus, far smaller than a pixel, seven in each cell. A few pixels see each.
TEST(TargetPilot, LampsInFocusAreKept) {
    World world;
    place_lamps(world.scene, 800, 3e-4f);
    place_wall(world.scene);
    const Grids grids = grids_of(world, camera::one_by_one, kFar_m);
    ASSERT_NE(grids.paying, nullptr);
    size_t found = 0, kept = 0;
    for (size_t i = 0; i < grids.all->lists.size(); ++i) {
        found += grids.all->lists[i].targets.size();
        kept += grids.paying->lists[i].targets.size();
    }
    EXPECT_GT(found, 4 * grids.all->lists.size());
    EXPECT_GT(double(kept), 0.99 * double(found));
}

// The pilot sends few rays to each, and some lamps are met by none: they are kept too.
TEST(TargetPilot, HundredsOfLampsAreAllKept) {
    World world;
    const std::vector<V3f> lamps = place_lamps(world.scene, 400);
    place_wall(world.scene);
    const Grids grids = grids_of(world);
    ASSERT_NE(grids.paying, nullptr);
    // Half even, and by a chance to be seen of a two-hundredth at least.
    expect_sane(grids, 0.5f * 0.005f);
    size_t longest = 0, found = 0, kept = 0;
    for (size_t i = 0; i < grids.all->lists.size(); ++i) {
        longest = std::max(longest, grids.all->lists[i].targets.size());
        found += grids.all->lists[i].targets.size();
        kept += grids.paying->lists[i].targets.size();
    }
    EXPECT_GT(longest, 80u);
    EXPECT_GT(double(kept), 0.99 * double(found));
    for (const V3f& lamp : lamps)
        EXPECT_GT(cells_with(*grids.paying, lamp), 0u)
            << lamp << ", of " << cells_with(*grids.all, lamp);
}

/// Whether a point of the lens sees a lamp by way of a point in focus.
bool passes_lens(const V3f& lamp, const V3f& in_focus) {
    const V3f at = lamp + (in_focus - lamp) * (lamp.z / (lamp.z - in_focus.z));
    return at.length() < 0.05f;
}

// The disc of a lamp in the corner of the frame, alone in its cells; a gap in a fence in focus lets
// a little of it through. The pilot's rays miss it at some gaps: other lamps say what it may bring.
TEST(TargetPilot, LampsThatFewPixelsSeeAreKept) {
    for (const bool in_corner : {true, false}) {
        // Of one in the corner few rays tell.
        const V3f corner = in_corner ? V3f(0.6f, 0.45f, -kFar_m) : V3f(0.3f, 0.2f, -kFar_m);
        const float gap_m = in_corner ? 5e-4f : 3e-3f;
        const float half_height = std::tan(0.15f), half_width = half_height * 4 / 3;
        int lost = 0, seen = 0;
        for (int i = 0; i < 12; ++i) {
            const float gap = corner.x / 3 - 0.025f + 0.002f * float(i);
            World world;
            place_lamp(world.scene, corner, 5e4f);
            place_lamp(world.scene, kOne, 5e4f);
            place_lamp(world.scene, kOther, 5e4f);
            place_wall(world.scene);
            place(world.scene, quad(V3f(0.05f, 0.02f, -1), V3f(gap - 0.05f, 0, 0), V3f(0, 1, 0)),
                  diffuse_material(0.5f));
            place(world.scene, quad(V3f(gap + gap_m, 0.02f, -1), V3f(1, 0, 0), V3f(0, 1, 0)),
                  diffuse_material(0.5f));
            const Grids grids = grids_of(world);
            ASSERT_NE(grids.paying, nullptr);
            const auto has = [&](const camera::TargetCell& cell) {
                return std::any_of(
                    cell.targets.begin(), cell.targets.end(),
                    [&](const camera::ListedTarget& t) { return is_at(*grids.all, t, corner); });
            };
            for (size_t n = 0; n < grids.all->lists.size(); ++n) {
                const V2i at(int(n) % grids.all->cells.x, int(n) / grids.all->cells.x);
                const camera::FilmCell cell = grids.all->cell(at.x, at.y);
                const V2f film = (cell.first + cell.last) / 2.f;
                const bool has_gap = std::fabs((gap / half_width + 1) / 2 - film.x) <
                                     (cell.last.x - cell.first.x) / 2;
                if (!has_gap || !passes_lens(corner, V3f(gap, (1 - 2 * film.y) * half_height, -1)))
                    continue;
                ++seen;
                lost += !has(grids.paying->lists[n]);
            }
        }
        EXPECT_GT(seen, 12) << corner;
        EXPECT_EQ(lost, 0) << "of " << seen << ", " << corner;
    }
}

TEST(TargetTasks, FindTheSameWhateverRunsThem) {
    World one, other;
    for (World* world : {&one, &other}) {
        place_lamps(world->scene, 40);
        place_wall(world->scene);
        Material mirror;
        mirror.metallic = 1, mirror.roughness = 0;
        for (const float x : {-0.1f, 0.f, 0.1f})
            place(world->scene, sphere(V3f(x, -0.05f, -2), 0.03f, 32, true), mirror);
        place_lamp(world->scene, V3f(0.5f, 1, 0), 1e5f);
    }
    const Grids plain = grids_of(one), threads = grids_of(other, test::backwards_on_two_threads);
    ASSERT_NE(plain.paying, nullptr);
    ASSERT_NE(threads.paying, nullptr);
    EXPECT_GT(std::count_if(plain.all->targets.begin(), plain.all->targets.end(),
                            [](const camera::Target& t) { return t.image.has_value(); }),
              0);
    ASSERT_EQ(plain.paying->lists.size(), threads.paying->lists.size());
    for (size_t i = 0; i < plain.paying->lists.size(); ++i) {
        const camera::TargetCell &a = plain.paying->lists[i], &b = threads.paying->lists[i];
        EXPECT_EQ(a.rays, b.rays);
        ASSERT_EQ(a.targets.size(), b.targets.size());
        for (size_t k = 0; k < a.targets.size(); ++k) {
            EXPECT_EQ(a.targets[k].number, b.targets[k].number);
            EXPECT_EQ(a.targets[k].chance, b.targets[k].chance);
            EXPECT_EQ(a.targets[k].seen_from.low, b.targets[k].seen_from.low);
        }
    }
}

}  // namespace
}  // namespace petzval::apps
