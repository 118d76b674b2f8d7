// SPDX-License-Identifier: Apache-2.0
// Ghosts, drawn from the film, against walks of light from the scene through the lens, which know
// neither cameras nor regions; and against matrices of paraxial optics.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "camera/ghosts/ghost_search.h"
#include "tests/measure/ghost_light.h"
#include "tests/support/targets.h"

namespace petzval::camera {
namespace {

using test::ghostly, test::hits, test::sun_at;

const Bands kRgb = Bands::rgb();

struct Sums {
    double sum = 0, squares = 0;
    void add(double a) { sum += a, squares += a * a; }
    [[nodiscard]] double variance(double of) const {
        return std::max(0., squares - sum * sum / of);
    }
};

/// Light of a disc that each sample of the camera brings.
Sums light_of(const Camera& camera, const SmallFeature& sun, uint32_t count) {
    Sums out;
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Independent, 5, {0, 0, i});
        double light = 0;
        for (const CameraPath& path : camera.sample({sampler.get2(Dim::Film), sampler}, kRgb))
            if (hits(path.ray, sun)) light += double(path.weight[0] * path.mis_weight);
        out.add(light);
    }
    return out;
}

// Spreads are those of the walked rays: of draws themselves the few that see the sun through a
// caustic may have most of the light.
TEST(Ghosts, HaveTheLightOfAWalkThroughTheLensPairByPair) {
    struct Case {
        const char* lens;
        double deg;
    };
    constexpr uint32_t kWalks = 40000, kDraws = 200000;
    for (const auto& [name, deg] : {Case{"takumar-50mm-f1.2", 10}, Case{"canon-14mm-f2.8-asph", 30},
                                    Case{"schneider-anamorphic-31mm", 8}}) {
        SCOPED_TRACE(name);
        const test::GhostLight ghosts(ghostly(name, Coating::Uncoated), sun_at(deg, 0.00465f));
        test::PairLights pairs;
        ghosts.walk(kWalks, pairs);
        ghosts.draw(kDraws, pairs);
        double walked = 0, drawn = 0, variance = 0;
        int tested = 0, unseen = 0;
        for (const auto& [pair, light] : pairs) {
            walked += light.walked / kWalks, drawn += light.drawn / kDraws;
            variance += light.error2(kWalks, kDraws);
            unseen += light.unseen;
        }
        for (const auto& [pair, light] : pairs) {
            const double walk = light.walked / kWalks;
            if (walk < 1e-3 * walked) continue;
            ++tested;
            // About 290 pairs in all: 2 in 10^4 for all of them together.
            EXPECT_NEAR(light.drawn / kDraws, walk,
                        5 * std::sqrt(light.error2(kWalks, kDraws)) + 0.005 * walk)
                << pair.first << "," << pair.second;
        }
        EXPECT_GT(tested, 40);
        EXPECT_NEAR(drawn, walked, 4 * std::sqrt(variance) + 0.002 * walked);
        // Whatever light gets through, draws find it.
        EXPECT_EQ(unseen, 0);
    }
}

// Of a lamp so wide that rays over all of the last surface find it as well.
TEST(GhostCamera, OfALampKeepTheirMeanWithRegionsAndWithout) {
    const auto camera = ghostly("takumar-50mm-f1.2", Coating::MgF2);
    const SmallFeature sun = sun_at(15, 0.12f);
    constexpr uint32_t kCount = 350000;
    const GhostOptics optics(camera);
    GhostRegions regions(optics, {&sun, 1});
    ASSERT_TRUE(regions.serve(V2f(0.f)));
    const auto draws = [&](GhostRegions of) {
        return std::make_shared<const GhostDraws>(optics, std::move(of));
    };
    const Sums with =
                   light_of(GhostCamera(nullptr, optics, draws(std::move(regions))), sun, kCount),
               without = light_of(GhostCamera(nullptr, optics, draws({})), sun, kCount);
    const double error = std::sqrt(with.variance(kCount) + without.variance(kCount));
    EXPECT_LT(error, 0.08 * without.sum);
    EXPECT_NEAR(with.sum, without.sum, 4 * error);
    EXPECT_LT(with.variance(kCount) * 4, without.variance(kCount))
        << with.sum << " " << without.sum << " " << with.variance(kCount) << " "
        << without.variance(kCount);
}

// So pairs are searched side by side, and a pair anew only where the parts ended within it.
TEST(GhostSearch, FindsTheSameForAnyNumberOfPartsThatItDoesNotUseUp) {
    const GhostOptics optics(ghostly("takumar-50mm-f1.2", Coating::Uncoated));
    const GhostSearch search(optics);
    const GhostLamp lamp{{0, std::sin(0.2), -std::cos(0.2)}, 0.005, true, 1};
    const auto rears = [&](uint32_t pair, int most_parts) {
        const GhostSearch::Found found = search.find(pair, lamp, most_parts);
        std::vector<std::tuple<float, float, float>> out;
        for (const GhostRegion& r : found.regions) out.emplace_back(r.rear.x, r.rear.y, r.light);
        return std::pair(found.parts, out);
    };
    int ended_soon = 0;
    for (uint32_t pair = 0; pair < optics.pairs().size(); ++pair) {
        const auto all = rears(pair, 1 << 30), with_one_left = rears(pair, all.first + 1),
                   half = rears(pair, all.first / 2);
        EXPECT_EQ(all, with_one_left);
        EXPECT_LE(half.first, all.first);
        ended_soon += half != all;
    }
    EXPECT_GT(ended_soon, 10);
}

TEST(GhostRegions, AreTheSameWhateverRunsTheSearch) {
    const auto camera = ghostly("double-gauss-100mm-f2", Coating::MgF2);
    const GhostOptics optics(camera);
    std::vector<SmallFeature> suns;
    for (const double deg : {3, 8, 14}) suns.push_back(sun_at(deg, 0.005f));
    const GhostDraws one(optics, GhostRegions(optics, suns)),
        other(optics, GhostRegions(optics, suns, test::backwards_on_two_threads),
              test::backwards_on_two_threads);
    int drawn = 0;
    for (uint32_t i = 0; i < 4000; ++i) {
        const Sampler sampler(SamplerKind::Owen, 6, {0, 0, i});
        const V2f film = camera->film_mm(sampler.get2(Dim::Film));
        const auto a = one.draw(film, 0, sampler), b = other.draw(film, 0, sampler);
        ASSERT_EQ(a.through_region.has_value(), b.through_region.has_value());
        if (!a.through_region) continue;
        ++drawn;
        constexpr float kLineD = 0;
        ASSERT_EQ(a.through_region->pair, b.through_region->pair);
        ASSERT_EQ(a.through_region->rear_mm, b.through_region->rear_mm);
        ASSERT_EQ(one.density(film, {&kLineD, 1}, *a.through_region),
                  other.density(film, {&kLineD, 1}, *b.through_region));
    }
    EXPECT_GT(drawn, 500);
}

// What leaves the lens for the scene comes back the same way.
TEST(Ghosts, TakeTheSameWayBackwards) {
    const auto camera = ghostly("canon-14mm-f2.8-asph", Coating::Uncoated);
    const GhostOptics optics(camera);
    const f4 nm = splat(float(kLineD_nm));
    const LensIndices<d4> indices = optics.lens().exact_indices(broadcast<d4>(kLineD_nm));
    int tested = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        const Sampler sampler(SamplerKind::Independent, 9, {0, 0, i});
        const GhostPair pair = optics.pairs()[i % optics.pairs().size()];
        const V2f film = camera->film_mm(sampler.get2(Dim::Film));
        const V2f rear = (sampler.get2(Dim::Lens) * 2.f - V2f(1)) * float(optics.rear_mm());
        const auto found =
            optics.ray(pair, film, rear, optics.lens().exact_indices(nm), nm, m4{-1, 0, 0, 0});
        if (!found) continue;
        EXPECT_GT(found->share[0], 0.f);
        EXPECT_LT(found->share[0], 0.1f);
        LensRay<d4> back;
        const auto lanes = [](const Vec3<f4>& v) {
            return Vec3<d4>{broadcast<d4>(double(v.x[0])), broadcast<d4>(double(v.y[0])),
                            broadcast<d4>(double(v.z[0]))};
        };
        back.origin = lanes(found->ray.origin);
        back.direction = lanes(found->ray.direction) * broadcast<d4>(-1);
        back.counted_from = found->ray.counted_from;
        ASSERT_TRUE(trace_ghost<d4>(optics.lens(), pair, Towards::Film, Clip::No, indices, back,
                                    [](const auto&, const GhostStep&) {})[0]);
        const double to_film =
            camera->input().film_mm - optics.lens().vertex_mm(back.counted_from) - back.origin.z[0];
        EXPECT_NEAR(back.origin.x[0] + to_film * back.direction.x[0] / back.direction.z[0],
                    double(film.x), 0.02);
        EXPECT_NEAR(back.origin.y[0] + to_film * back.direction.y[0] / back.direction.z[0],
                    double(film.y), 0.02);
        ++tested;
    }
    EXPECT_GT(tested, 300);
}

TEST(Ghosts, AreNotThereWhereNothingReflects) {
    EXPECT_TRUE(GhostOptics(ghostly("takumar-50mm-f1.2", Coating::Ideal)).pairs().empty());
    // 10 surfaces against air or cement of the double Gauss, the stop apart.
    EXPECT_EQ(GhostOptics(ghostly("double-gauss-100mm-f2", Coating::Uncoated)).pairs().size(), 45u);
}

}  // namespace
}  // namespace petzval::camera
