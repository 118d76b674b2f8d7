// SPDX-License-Identifier: Apache-2.0
// Rays to targets: whatever the targets are, the mean is that of ordinary rays.
#include <gtest/gtest.h>

#include <cmath>

#include "camera/models/aberrated_lens.h"
#include "camera/models/thin_lens.h"
#include "camera/targets/make_target_camera.h"
#include "camera/targets/targeted_stop.h"
#include "core/sampling/warp.h"
#include "core/spectrum/observer.h"
#include "tests/support/lens_cameras.h"
#include "tests/support/observers.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::Mean;

const M44f kPose = look_at(V3f(0.1f, 0.2f, 0.3f), V3f(0.3f, 0.1f, -2));

LocalTarget local(const V3d& centre, double radius_m, bool at_infinity = false) {
    return {at_infinity ? centre.normalized() : centre, V3d(centre).normalized(), radius_m,
            at_infinity};
}

/// A pencil in focus at a metre; half_k: spherical aberration that folds it.
StopPencil pencil(double half_k_per_m) {
    return {V2d(0.1, -0.05), 0.05, half_k_per_m, 1 / 0.05 - 1, 0.02};
}

V2f random2(uint32_t i, uint32_t purpose) {
    return {to_unit_float(hash32(hash32(i, purpose), 0)),
            to_unit_float(hash32(hash32(i, purpose), 1))};
}

// The density integrates to the share of draws that reach a point of the stop: as a mean over the
// stop, against how often aim() finds one. Returns that share.
double expect_same_share(const StopPencil& rays, const LocalTarget& target) {
    test::Moments density, found;
    for (uint32_t i = 0; i < 40'000; ++i) {
        const V2d s = V2d(uniform_disk(random2(i, 1))) * rays.reach_m;
        density.add(aimed_density(rays, target, s) * 3.14159265 * rays.reach_m * rays.reach_m);
        const auto aimed = aim(rays, target, random2(i, 2), random2(i, 3).x);
        const bool inside = aimed && aimed->length() <= rays.reach_m;
        found.add(inside);
        if (inside) {
            EXPECT_GT(aimed_density(rays, target, *aimed * 0.9999999), 0) << i;
        }
    }
    const Mean apart = Mean(density) - Mean(found);
    EXPECT_TRUE(test::agrees(apart, 0)) << Mean(density) << ", " << Mean(found);
    return found.mean();
}

/// Target on the ray of a point of the stop.
LocalTarget on_ray(const StopPencil& rays, double z, bool at_infinity) {
    const V3d d = rays.direction(V2d(0.006, 0.004));
    return at_infinity ? local(d, 0.003, true) : local(V3d(0.006, 0.004, 0) + d * -z, 0.002 * -z);
}

TEST(Targets, DensitiesAreThoseOfTheDraws) {
    int folded = 0;
    for (const double k : {0., 8., 40.})
        for (const double z : {-0.6, -0.95, -1.4, -4.})
            for (const bool at_infinity : {false, true}) {
                SCOPED_TRACE(testing::Message() << k << ' ' << z << ' ' << at_infinity);
                const StopPencil rays = pencil(k);
                folded += expect_same_share(rays, on_ray(rays, z, at_infinity)) < 0.9;
            }
    EXPECT_GT(folded, 0);
}

// Far from the axis, where the tilt of a target counts for much.
TEST(Targets, DensitiesAreThoseOfTheDrawsAtWideAngles) {
    StopPencil rays = pencil(0);
    rays.tangents = V2d(1, -0.8);
    for (const bool at_infinity : {false, true}) {
        SCOPED_TRACE(at_infinity);
        EXPECT_GT(expect_same_share(rays, on_ray(rays, -4, at_infinity)), 0.5);
    }
}

/// Light that a test puts in the scene: a lamp of some mm out of focus before a soft background.
float light_along(const Ray& ray, const V3f& lamp, float radius_m) {
    const V3f to = lamp - ray.origin;
    const float along = to.dot(ray.direction);
    const bool met = along > 0 && (to - along * ray.direction).length2() < radius_m * radius_m;
    return (met ? 300.f : 0.f) + 1 + ray.direction.x;
}

constexpr uint32_t kSamples = 16'384;

/// Mean of a camera's estimates for one pixel, with and without rays to targets.
struct Means {
    test::Moments ordinary, both;
};
Means means(const TargetCamera& camera, const Observer& observer, V2f film, const V3f& lamp,
            float radius_m, TargetList targets) {
    Means out;
    const Filter filter(FilterKind::Box, 0.5f);
    const V2f size(320, 200);
    std::array<FilmPoint, kMostFilmPoints> points;
    std::array<Bands, kMostFilmPoints> bands;
    std::array<TargetList, kMostFilmPoints> lists;
    lists.fill(targets);
    std::array<CameraSample, kMostFilmPoints> ordinary, to_targets;
    for (uint32_t first = 0; first < kSamples; first += kMostFilmPoints) {
        for (uint32_t k = 0; k < kMostFilmPoints; ++k) {
            const Sampler sampler(SamplerKind::Independent, 3, {7, 9, first + k});
            bands[k] =
                observer.spectral() ? observer.draw(sampler.get1(Dim::Wavelength)) : Bands::rgb();
            const V2f offset = filter.sample(sampler.get2(Dim::Film));
            points[k] = {film + offset / size, sampler, {&filter, offset, size}};
        }
        camera.sample_beside(points, bands, lists, ordinary);
        camera.sample_targets(points, bands, lists, to_targets);
        for (uint32_t k = 0; k < kMostFilmPoints; ++k) {
            double whole = 0, shared = 0;
            const auto add = [&](const CameraPath& path) {
                const double light =
                    double(hsum(path.weight)) * light_along(path.ray, lamp, radius_m);
                whole += light;
                shared += light * double(path.mis_weight);
            };
            for (const CameraPath& path : ordinary[k]) add(path);
            out.ordinary.add(whole);
            for (const CameraPath& path : to_targets[k]) add(path);
            out.both.add(shared);
        }
    }
    return out;
}

std::shared_ptr<TargetGrid> one_list(const TargetCamera& camera, V2f film,
                                     const std::vector<Target>& targets) {
    auto out = std::make_shared<TargetGrid>();
    out->cells = {1, 1};
    out->lists.emplace_back();
    float sum = 0;
    for (size_t i = 0; i < targets.size(); ++i) {
        const auto prepared = camera.prepared(targets[i]);
        if (!prepared) continue;
        auto ready = camera.listed(*prepared, {film, film});
        if (!ready) continue;
        ready->chance = float(i + 1);
        sum += ready->chance;
        out->lists[0].push_back(*ready);
    }
    for (ListedTarget& listed : out->lists[0]) listed.chance /= sum;
    return out;
}

/// Ray of a film point: that of draw number i, or of the first after it that passes.
Ray ray_of(const Camera& camera, V2f film, uint32_t i) {
    for (;; ++i) {
        const FilmPoint at{film, Sampler(SamplerKind::Owen, 5, {0, 0, i})};
        const CameraSample sample = camera.sample(at, Bands::rgb());
        if (!sample.empty()) return sample[0].ray;
    }
}

/// A lamp on a ray of a film point.
struct TestLamp {
    V2f film;
    float distance_m, radius_m;
    bool pays;  ///< it is much smaller than the circle of confusion, and lies beside caustics
    uint32_t draw = 1;  ///< number of the draw whose ray it lies on
};

/// Targets of the right place and size, and wrong ones: the mean must be the same with all. Returns
/// the most starts that one of them has.
int expect_same_mean(TargetCamera& camera, const Observer& observer, const TestLamp& lamp) {
    const Ray ray = ray_of(camera, lamp.film, lamp.draw);
    const V3f at = ray.origin + lamp.distance_m * ray.direction, axis = ray.direction;
    const float radius = lamp.radius_m;
    const auto disc = [&](const V3f& beside, float radius_m) {
        return Target{at + beside, axis, radius_m, false};
    };
    const V3f beside = unit(axis.cross(V3f(0, 1, 0))) * (0.75f * radius);
    const std::vector<std::vector<Target>> cases{
        {disc(V3f(0.f), radius)},
        {disc(V3f(0.f), radius / 3)},
        {disc(V3f(0.f), radius * 5)},
        {disc(beside, radius), disc(-beside, radius / 2), disc(beside + axis * 0.1f, radius)},
        {{axis, axis, 0.003f, true}, disc(beside * 9.f, radius)}};
    double least = INFINITY, plain = 0;
    int starts = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
        camera.set_targets(one_list(camera, lamp.film, cases[i]));
        for (const ListedTarget& listed : camera.targets()->lists[0])
            starts = std::max<int>(starts, listed.start_count);
        const Means found =
            means(camera, observer, lamp.film, at, radius, camera.targets()->lists[0]);
        // They share their ordinary rays, so this allows a little more than chance does.
        EXPECT_TRUE(test::agrees(Mean(found.both) - Mean(found.ordinary), 0))
            << "targets " << i << ", lamp at " << lamp.distance_m << " m: " << Mean(found.both)
            << ", " << Mean(found.ordinary);
        least = std::min(least, found.both.standard_error());
        plain = found.ordinary.standard_error();
    }
    if (lamp.pays) {
        EXPECT_LT(least, plain / 3) << "the right target pays, lamp at " << lamp.distance_m;
    }
    return starts;
}

TEST(Targets, ThinLensKeepsItsMean) {
    for (const float distance_m : {0.6f, 4.f}) {
        ThinLens lens{kPose, 0.5f, 1.6f, Iris(ApertureShape(), 20), 1.f};
        lens.vignetting.emplace(50, 1);
        const auto camera = target_camera(std::make_shared<ThinLensCamera>(lens));
        expect_same_mean(*camera, Observer(), {V2f(0.5f), distance_m, 0.004f, distance_m > 1});
    }
}

// Strongly aberrated, so that the pencil folds near its caustic, with each way of wavelengths.
TEST(Targets, SingletKeepsItsMean) {
    const Glass glass{"crown", IndexTable{{{400, 1.53}, {587, 1.517}, {700, 1.513}}}};
    for (const auto mode : {DispersionMode::Shared, DispersionMode::Split, DispersionMode::Hero})
        for (const float distance_m : {0.7f, 0.9f, 3.f}) {
            AberratedLens lens{
                kPose, Singlet::bent(glass, 50, 0.8), Iris(ApertureShape(), 9), 1, 0.5f, 1.6f,
                mode};
            const auto camera = target_camera(std::make_shared<AberratedLensCamera>(lens));
            expect_same_mean(*camera, test::plain_observer(),
                             {V2f(0.5f), distance_m, 0.001f, distance_m > 1});
        }
}

// As many rays are sent to a target and get there as the density says of the ordinary rays that
// pass it: beside caustics, at them, and where the pupil itself folds.
TEST(Targets, DensitiesOfTracedLensesAreThoseOfTheDraws) {
    struct Case {
        const char* lens;
        V2f film;
        float distance_m, radius_m;
        uint32_t draw;
    };
    const V2f middle(0.5f), corner(0.12f, 0.9f), rim(0.02f, 0.03f);
    const std::vector<Case> cases{{"takumar-50mm-f1.2", middle, 3, 0.016f, 1},
                                  {"takumar-50mm-f1.2", middle, 3, 0.016f, 3},
                                  {"takumar-50mm-f1.2", corner, 1, 0.016f, 1},
                                  {"double-gauss-100mm-f2", corner, 20, 0.02f, 1},
                                  {"double-gauss-100mm-f2", middle, 3, 0.01f, 1},
                                  {"double-gauss-100mm-f2", middle, 3, 1e4f, 1},
                                  {"minolta-fisheye-16mm-f2.8", corner, 0.3f, 0.002f, 1},
                                  {"schneider-anamorphic-31mm", V2f(0.06f, 0.95f), 0.7f, 0.01f, 1}};
    for (const Case& c : cases) {
        const auto aims = target_camera(
            std::make_shared<LensCamera>(test::input_of(c.lens, DispersionMode::Shared)));
        TargetCamera& camera = *aims;
        const Ray ray = ray_of(camera, c.film, c.draw);
        const bool at_infinity = c.radius_m > 1e3f;
        const Target target = at_infinity ? Target{ray.direction, ray.direction, 0.004f, true}
                                          : Target{ray.origin + ray.direction * c.distance_m,
                                                   ray.direction, c.radius_m, false};
        camera.set_targets(one_list(camera, c.film, {target}));
        const TargetList list = camera.targets()->lists[0];
        test::Moments expected, found;
        const Bands bands = Bands::rgb();
        for (uint32_t i = 0; i < 4 * kSamples; ++i) {
            const FilmPoint at{c.film, Sampler(SamplerKind::Independent, 4, {0, 0, i})};
            CameraSample ordinary, sent;
            camera.sample_beside({&at, 1}, {&bands, 1}, {&list, 1}, {&ordinary, 1});
            // The share is p / (p + q), with the densities p of ordinary rays and q.
            const double share = ordinary.empty() ? 1 : double(ordinary[0].mis_weight);
            expected.add((1 - share) / share);
            camera.sample_targets({&at, 1}, {&bands, 1}, {&list, 1}, {&sent, 1});
            found.add(sent.empty() ? 0 : 1);
        }
        EXPECT_TRUE(test::agrees(Mean(expected) - Mean(found), 0))
            << c.lens << ' ' << c.distance_m << ' ' << int(list[0].start_count)
            << " starts: " << Mean(expected) << ", " << Mean(found);
        EXPECT_LT(expected.standard_error(), 0.03 * found.mean()) << c.lens << ' ' << c.distance_m;
    }
}

TEST(Targets, TracedLensesKeepTheirMean) {
    using enum DispersionMode;
    struct Case {
        const char* lens;
        DispersionMode mode;
        Precision precision;
        TestLamp lamp;
        bool folds = false;
    };
    const V2f middle(0.5f), corner(0.12f, 0.9f);
    const char *takumar = "takumar-50mm-f1.2", *gauss = "double-gauss-100mm-f2",
               *fisheye = "minolta-fisheye-16mm-f2.8", *anamorphic = "schneider-anamorphic-31mm";
    constexpr auto kFloat = Precision::Float, kDouble = Precision::Double;
    // Rays near the rim of the stop are next to the caustic that spherical aberration makes.
    const TestLamp near{middle, 3, 0.002f, true}, aside{corner, 3, 0.002f, true},
        rim{middle, 3, 0.002f, false, 3}, far{corner, 20, 0.003f, false};
    const std::vector<Case> cases{
        {takumar, Shared, kFloat, near},
        {takumar, Split, kFloat, aside},
        {takumar, Hero, kFloat, aside},
        {takumar, Shared, kDouble, aside},
        {takumar, Hero, kDouble, near},
        {takumar, Split, kDouble, near},
        {takumar, Shared, kFloat, rim, true},
        {takumar, Split, kFloat, rim, true},
        {takumar, Hero, kFloat, rim, true},
        {takumar, Hero, kFloat, {middle, 500, 0.05f, false}},
        {gauss, Shared, kFloat, far, true},
        {gauss, Split, kFloat, far, true},
        {gauss, Hero, kFloat, far, true},
        {fisheye, Split, kFloat, {V2f(0.1f, 0.5f), 0.3f, 4e-4f, true}},
        {fisheye, Shared, kFloat, {corner, 0.3f, 4e-4f, true}},
        {anamorphic, Split, kFloat, {middle, 0.7f, 0.001f, false}},
        {anamorphic, Shared, kFloat, {V2f(0.06f, 0.95f), 0.7f, 0.004f, false}}};
    for (const Case& c : cases) {
        SCOPED_TRACE(c.lens);
        LensCameraInput in = test::input_of(c.lens, c.mode);
        in.precision = c.precision;
        const auto camera = target_camera(std::make_shared<LensCamera>(in));
        const int starts = expect_same_mean(*camera, test::plain_observer(), c.lamp);
        EXPECT_GE(starts, c.folds ? 2 : 1);
    }
}

}  // namespace
}  // namespace petzval
