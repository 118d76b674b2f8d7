// SPDX-License-Identifier: Apache-2.0
// Ghosts of another view of a scene: taken where they are the same, and else searched anew.
#include <gtest/gtest.h>

#include "apps/setup/ghosts.h"

namespace petzval::apps {
namespace {

const io::Notice kQuiet = [](const std::string&) {};

SceneRequest low_sun() {
    SceneRequest out;
    out.scene = PETZVAL_ASSETS "/scenes/low_sun.glb";
    out.size = {48, 32};
    out.camera.lens = "double-gauss-100mm-f2";
    out.camera.focus = FocusDistance{9};
    out.camera.coating = camera::Coating::MgF2;
    return out;
}

/// Whether all rays of some film points are the same, to the bit.
bool same_samples(const RenderSetup& a, const RenderSetup& b) {
    int rays = 0;
    for (uint32_t i = 0; i < 4000; ++i) {
        const Sampler sampler(SamplerKind::Owen, 1, {0, 0, i});
        const camera::FilmPoint at{sampler.get2(Dim::Film), sampler};
        const camera::CameraSample of_a = a.view.camera->sample(at, Bands::rgb()),
                                   of_b = b.view.camera->sample(at, Bands::rgb());
        if (of_a.size() != of_b.size()) return false;
        for (size_t k = 0; k < of_a.size(); ++k) {
            const camera::CameraPath &one = of_a[k], &other = of_b[k];
            if (one.ray.origin != other.ray.origin || one.ray.direction != other.ray.direction ||
                one.weight[0] != other.weight[0] || one.mis_weight != other.mis_weight)
                return false;
            rays += one.of_ghost;
        }
    }
    EXPECT_GT(rays, 100);
    return true;
}

TEST(GhostsSetup, AnotherViewTakesThemWhereTheyAreTheSame) {
    const RenderSetup first = set_up_render(low_sun(), kQuiet);
    ASSERT_NE(first.view.ghosts, nullptr);
    const auto expect = [&](bool taken, const std::function<void(SceneRequest&)>& change) {
        SceneRequest other = low_sun();
        change(other);
        const RenderSetup view = set_up_view(first, other, kQuiet);
        ASSERT_NE(view.view.ghosts, nullptr);
        EXPECT_EQ(view.view.ghosts == first.view.ghosts, taken);
        EXPECT_TRUE(same_samples(view, set_up_render(other, kQuiet)));
    };
    expect(true, [](SceneRequest&) {});
    expect(true, [](SceneRequest& s) { s.size = {30, 20}; });
    expect(true, [](SceneRequest& s) { s.camera.dispersion = camera::DispersionMode::Shared; });
    expect(true, [](SceneRequest& s) { s.camera.ghosts = GhostUse::Only; });
    expect(false, [](SceneRequest& s) { s.camera.coating = camera::Coating::Uncoated; });
    expect(false, [](SceneRequest& s) { s.camera.focus = FocusDistance{5}; });
    expect(false, [](SceneRequest& s) { s.camera.fstop = 8; });
    expect(false, [](SceneRequest& s) { s.camera.aperture = "star:5"; });
    expect(false, [](SceneRequest& s) {
        s.camera.look_at = std::array{V3f(0, 1, 9), V3f(0, 2, 0)};
    });
    expect(false, [](SceneRequest& s) { s.camera.lens = "cooke-triplet-50mm-f5"; });
}

TEST(GhostsSetup, ViewsWithoutThemHaveNone) {
    const RenderSetup first = set_up_render(low_sun(), kQuiet);
    SceneRequest off = low_sun(), ideal = low_sun();
    off.camera.ghosts = GhostUse::Off;
    ideal.camera.coating = camera::Coating::Ideal;
    for (const SceneRequest& without : {off, ideal}) {
        const RenderSetup view = set_up_view(first, without, kQuiet);
        EXPECT_EQ(view.view.ghosts, nullptr);
        // They are searched where the setup before had none.
        EXPECT_TRUE(same_samples(set_up_view(view, low_sun(), kQuiet), first));
    }
}

TEST(GhostsSetup, LampsThatShineIntoTheLensAreCounted) {
    const auto lamps = [](const std::function<void(SceneRequest&)>& change) {
        SceneRequest asked = low_sun();
        change(asked);
        const RenderSetup setup = set_up_render(asked, kQuiet);
        return lamps_into_lens(setup.view, small_features_of(*setup.prepared.scene),
                               *setup.prepared.bvh);
    };
    EXPECT_EQ(lamps([](SceneRequest&) {}), 1u);
    EXPECT_EQ(lamps([](SceneRequest& s) { s.camera.coating = camera::Coating::Ideal; }), 1u);
    // It looks the other way, and as a thin lens.
    EXPECT_EQ(lamps([](SceneRequest& s) {
                  s.camera.look_at = std::array{V3f(0, 2, 0), V3f(0, 2, 9)};
              }),
              0u);
    EXPECT_EQ(lamps([](SceneRequest& s) {
                  s.camera.lens = "thin";
                  s.camera.fstop = 2.f;
                  s.camera.coating = camera::Coating::Ideal;
              }),
              0u);
}

// The setup of a page that has moved on ends soon.
TEST(GhostsSetup, TheSearchEndsWhereItIsNotWanted) {
    struct Enough {};
    const auto steps_of = [](const SceneRequest& asked, int most) {
        int steps = 0;
        const auto begins = [&](Phase) {
            if (++steps > most) throw Enough();
        };
        static_cast<void>(set_up_render(asked, kQuiet, begins));
        return steps;
    };
    SceneRequest off = low_sun();
    off.camera.ghosts = GhostUse::Off;
    const int without = steps_of(off, 1 << 30);
    EXPECT_GT(steps_of(low_sun(), 1 << 30), without + 2);
    EXPECT_THROW(steps_of(low_sun(), without), Enough);
}

}  // namespace
}  // namespace petzval::apps
