// SPDX-License-Identifier: Apache-2.0
// The two-level estimator: no bias at any probability, and what its pilot learns.
#include "integrator/two_level.h"

#include <gtest/gtest.h>

#include <cstring>

#include "camera/aberrated_lens.h"
#include "camera/lens_camera.h"
#include "camera/two_level.h"
#include "integrator/executor.h"
#include "integrator/render.h"
#include "tests/support/observers.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::least_p;

const V2i kSize(48, 32);
const Rect kWhole{0, 0, kSize.x, kSize.y};

/// One lens of 100 mm at f/4, whose index falls from `blue` at 400 nm to `red` at 700 nm. It looks
/// along -z, is focused far away, and its pixels are 0.2 mm wide.
LensCameraInput singlet(Chroma chroma, double blue = 1.70, double red = 1.62) {
    Prescription p;
    const auto add = [&p](double curvature, double thickness, bool stop) -> LensSurface& {
        LensSurface s;
        s.curvature_1_mm = curvature;
        s.thickness_mm = thickness;
        s.semi_diameter_mm = 20;
        s.stop = stop;
        return p.surfaces.emplace_back(std::move(s));
    };
    add(0, 1, true);
    add(0.0077, 4, false).glass = Glass{"as given", IndexTable{{{400, blue}, {700, red}}}};
    add(-0.0077, 98, false);
    const auto lens = std::make_shared<const Lens>(p);
    LensCameraInput in{.lens = lens, .iris = Iris(Disk{}, 12.5), .to_world = M44f()};
    in.film_mm = lens->film_mm();
    in.film_width_mm = 9.6;
    in.film_height_mm = 6.4;
    in.chroma = chroma;
    return in;
}

RenderJob job_of(uint32_t spp, uint32_t seed = 0) {
    static const Observer observer = test::observer_of({});
    RenderJob job;
    job.observer = observer;
    job.end_sample = spp;
    job.seed = seed;
    return job;
}

Bands four_wavelengths() {
    return job_of(1).observer.draw(0.1f);
}

/// A lamp with edges far away, in a dim sky.
struct Edges : test::World {
    Edges() {
        test::place(scene, test::quad(V3f(-15, -20, -1000), V3f(25, 0, 0), V3f(0, 40, 0)),
                    test::emitter_material(1.f));
        scene.sky = Sky::uniform(Rgb(0.1f));
        finish();
        tracer.emplace(scene, *bvh, *lights, PathOptions());
    }
    std::optional<PathTracer<>> tracer;
};

Film picture(const Camera& camera, const RenderJob& job, int threads = 2, Rect crop = kWhole) {
    static const Edges edges;
    Film film(kSize, crop, {});
    ThreadExecutor executor(threads);
    RenderMonitor monitor;
    static_cast<void>(render(*edges.tracer, camera, job, film, executor, monitor));
    EXPECT_EQ(film.bad_count(), 0u);
    return film;
}

void expect_same_bytes(const Film& a, const Film& b, Rect where = kWhole) {
    int differ = 0;
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            const V4f ca = a.colour(x, y), cb = b.colour(x, y);
            differ += std::memcmp(&ca, &cb, sizeof ca) != 0;
        }
    EXPECT_EQ(differ, 0);
}

/// Mean light of each lane from one side of an edge at infinity, a tenth of a degree off the axis.
std::array<test::Moments, 4> beyond_edge(const Camera& camera, float probability) {
    const Bands bands = four_wavelengths();
    std::array<test::Moments, 4> out;
    for (uint32_t i = 0; i < 1 << 16; ++i) {
        const Sampler sampler(SamplerKind::Independent, 3, {0, 0, i});
        const V2f film = V2f(0.5f) + 0.02f * (sampler.get2(Dim::Film) - V2f(0.5f));
        const CameraSample seen = camera.sample({film, sampler, probability}, bands);
        f4 sum{};
        for (int k = 0; k < seen.count; ++k) {
            const CameraPath& path = seen.path[size_t(k)];
            if (path.ray.direction.x > -0.0017f * path.ray.direction.z) sum += path.weight;
        }
        for (size_t lane = 0; lane < 4; ++lane) out[lane].add(double(sum[int(lane)]));
    }
    return out;
}

// The estimates share their numbers: the errors are overestimates, which the test of power makes
// up for.
TEST(TwoLevel, EachLaneHasTheMeanOfSplitPaths) {
    const auto check = [](const Camera& two_level, const Camera& split, const Camera& shared) {
        ASSERT_TRUE(two_level.two_level());
        const auto expected = beyond_edge(split, 1);
        for (const float p : {0.1f, 0.5f, 0.9f, 1.f})
            EXPECT_GE(least_p(beyond_edge(two_level, p), expected), test::sidak()) << p;
        EXPECT_LT(least_p(beyond_edge(shared, 1), expected), 1e-12);
        EXPECT_LT(least_p(beyond_edge(two_level, 0), expected), 1e-12);
    };
    check(LensCamera(singlet(Chroma::TwoLevel)), LensCamera(singlet(Chroma::Split)),
          LensCamera(singlet(Chroma::Shared)));
    const auto thin = [](Chroma chroma) {
        const Glass flint{"as given", IndexTable{{{360, 1.72}, {830, 1.60}}}};
        AberratedLens lens{.to_world = M44f(),
                           .singlet = {flint, 129, -129},
                           .iris = Iris(Disk{}, 12.5),
                           .focus_m = 1e6,
                           .yfov_rad = 0.06f};
        lens.chroma = chroma;
        return AberratedLensCamera(lens);
    };
    check(thin(Chroma::TwoLevel), thin(Chroma::Split), thin(Chroma::Shared));
}

// Without dispersion all rays are the one of line d, but for the rounding of the march's lanes.
TEST(TwoLevel, ALensWithoutDispersionHasNoDifference) {
    for (const March march : {March::Float, March::Double}) {
        LensCameraInput in = singlet(Chroma::TwoLevel, 1.65, 1.65);
        in.march = march;
        const LensCamera camera(in);
        const Bands bands = four_wavelengths();
        int compared = 0;
        for (uint32_t i = 0; i < 1000; ++i) {
            const FilmPoint at{V2f(0.3f, 0.8f), Sampler(SamplerKind::Owen, 1, {0, 0, i}), 0};
            FilmPoint always = at;
            always.split_probability = 1;
            const CameraSample shared = camera.sample(at, bands),
                               split = camera.sample(always, bands);
            ASSERT_EQ(split.count, 4 * shared.count);
            for (int k = 0; k < split.count; ++k, ++compared) {
                const CameraPath &a = shared.path[0], &b = split.path[size_t(k)];
                ASSERT_LT((a.ray.origin - b.ray.origin).length(), 1e-7f);
                ASSERT_LT((a.ray.direction - b.ray.direction).length(), 3e-7f);
                ASSERT_NEAR(b.weight[k], a.weight[k], 1e-5);
                ASSERT_EQ(lane_count(b.lanes), 4) << "decides as the shared path does";
            }
        }
        EXPECT_GT(compared, 3000);
    }
}

TEST(TwoLevel, PathsAreSharedOrBoth) {
    const LensCamera camera(singlet(Chroma::TwoLevel));
    const Bands bands = four_wavelengths();
    int with = 0, most = 0;
    for (uint32_t i = 0; i < 4096; ++i) {
        const FilmPoint at{V2f(0.5f), Sampler(SamplerKind::Owen, 7, {0, 0, i}), 0.25f};
        const CameraSample seen = camera.sample(at, bands);
        const bool difference = seen.lanes.drawn == 8;
        ASSERT_EQ(seen.lanes.drawn, difference ? 8u : 4u);
        ASSERT_LE(seen.count, difference ? 5 : 1);
        with += difference;
        most = std::max(most, seen.count);
    }
    EXPECT_EQ(with, 1024);  // its dimension is stratified
    EXPECT_EQ(most, 5);
    EXPECT_EQ(
        camera.sample({V2f(0.5f), Sampler(SamplerKind::Owen, 7, {0, 0, 1})}, Bands::rgb()).count,
        1);
}

// Every column of the picture, in three channels, over seeds.
TEST(TwoLevel, PicturesAgreeWithSplitOnes) {
    constexpr uint32_t kSeeds = 64;
    using Columns = std::vector<std::array<test::Moments, 3>>;
    const auto columns = [](Chroma chroma, float probability, uint32_t first_seed) {
        const LensCamera camera(singlet(chroma));
        Columns out(size_t(kSize.x));
        for (uint32_t i = 0; i < kSeeds; ++i) {
            RenderJob job = job_of(2, first_seed + i);
            job.sampler = SamplerKind::Independent;
            if (probability > 0) job.split = std::make_shared<SplitGrid>(kSize, probability);
            const Film film = picture(camera, job);
            for (int x = 0; x < kSize.x; ++x)
                for (int c = 0; c < 3; ++c) {
                    double sum = 0;
                    for (int y = 0; y < kSize.y; ++y) sum += double(film.colour(x, y)[c]);
                    out[size_t(x)][size_t(c)].add(sum / kSize.y);
                }
        }
        return out;
    };
    // The least of all, by Bonferroni.
    const auto agreement = [](const Columns& a, const Columns& b) {
        double least = 1;
        for (size_t x = 0; x < a.size(); ++x)
            for (size_t c = 0; c < 3; ++c) {
                const double error = std::hypot(a[x][c].standard_error(), b[x][c].standard_error());
                least =
                    std::min(least, test::two_sided_p((a[x][c].mean() - b[x][c].mean()) / error));
            }
        return least * 3 * double(a.size());
    };
    const Columns split = columns(Chroma::Split, 0, 100);
    EXPECT_GE(agreement(columns(Chroma::TwoLevel, 0.1f, 200), split), test::sidak());
    EXPECT_GE(agreement(columns(Chroma::TwoLevel, 0.5f, 300), split), test::sidak());
    EXPECT_GE(agreement(columns(Chroma::TwoLevel, 0, 400), split), test::sidak()) << "learned";
    EXPECT_LT(agreement(columns(Chroma::Shared, 0, 500), split), 1e-9);
}

TEST(TwoLevel, PixelsDoNotDependOnThreadsTilesCropsOrPasses) {
    const LensCamera camera(singlet(Chroma::TwoLevel));
    const Film whole = picture(camera, job_of(8), 1);
    expect_same_bytes(whole, picture(camera, job_of(8), 5));
    RenderJob small = job_of(8);
    small.tile_size_px = 5;
    expect_same_bytes(whole, picture(camera, small));
    const Rect crop{11, 6, 30, 29};
    expect_same_bytes(whole, picture(camera, job_of(8), 2, crop), crop);
    RenderJob rest = job_of(8);
    rest.first_sample = 4;
    const Film first = picture(camera, job_of(4)), last = picture(camera, rest);
    for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x)
            for (int i = 0; i < 3; ++i)
                ASSERT_NEAR(whole.colour(x, y)[i],
                            (first.colour(x, y)[i] + last.colour(x, y)[i]) / 2, 1e-6);
}

TEST(SplitPilot, LearnsWhereTheDifferenceIs) {
    static const Edges edges;
    const LensCamera camera(singlet(Chroma::TwoLevel));
    const RenderJob job = job_of(1);
    const V2i size(160, 96);
    const SplitPilot pilot(*edges.tracer, camera, job.observer, job.filter, size, 5);
    ThreadExecutor executor(2);
    const SplitGrid grid = pilot.learn({0, 0, size.x, size.y}, executor, false);
    // The lamp's edges are in the middle, blurred; in the corner is nothing but the dim sky.
    EXPECT_EQ(grid.at(0, 0), static_cast<float>(kLeastSplitProbability));
    float most = 0;
    for (int x = 0; x < size.x; ++x) most = std::max(most, grid.at(x, 48));
    EXPECT_EQ(most, 1.f);
    // For a crop it learns the same, and nothing elsewhere.
    for (int y = 0; y < size.y; y += SplitGrid::kCell_px)
        for (int x = 0; x < size.x; x += SplitGrid::kCell_px) {
            const SplitGrid part = pilot.learn({x, y, x + 1, y + 1}, executor, false);
            EXPECT_EQ(part.at(x, y), grid.at(x, y)) << x << ' ' << y;
            EXPECT_EQ(part.at((x + 80) % size.x, y), 1.f);
        }
}

TEST(SplitProbability, IsTheBestOfItsRange) {
    EXPECT_EQ(split_probability(0), kLeastSplitProbability);
    EXPECT_EQ(split_probability(1), 1);
    EXPECT_EQ(split_probability(std::nan("")), 1);
    for (double share = 0.01; share < 1; share *= 1.1) {
        const auto inefficiency = [share](double p) {
            return p == 1 ? kSplitCost : (1 + (1 / p - 1) * share) * (1 + p * kDifferenceCost);
        };
        const double chosen = inefficiency(split_probability(share));
        for (double p = kLeastSplitProbability; p < 1; p += 0.01)
            EXPECT_LE(chosen, inefficiency(p) + 1e-12) << share << ' ' << p;
        EXPECT_LE(chosen, kSplitCost);
    }
}

}  // namespace
}  // namespace petzval
