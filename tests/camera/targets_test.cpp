// SPDX-License-Identifier: Apache-2.0
// Rays to targets: whatever the targets are, the mean is that of ordinary rays.
#include <gtest/gtest.h>

#include <cmath>

#include "camera/models/aberrated_lens.h"
#include "camera/models/stop_pencil.h"
#include "camera/models/thin_lens.h"
#include "core/sampling/warp.h"
#include "core/spectrum/observer.h"
#include "tests/support/observers.h"
#include "tests/support/statistics.h"

namespace petzval {
namespace {

using test::Mean;

const M44f kPose = look_at(V3f(0.1f, 0.2f, 0.3f), V3f(0.3f, 0.1f, -2));

LocalTarget local(const V3d& centre, double radius_m, bool at_infinity = false) {
    Target none{};
    LocalTarget out(none, Pose(M44f()));
    out.centre = at_infinity ? centre.normalized() : centre;
    out.normal = V3d(centre).normalized();
    out.radius_m = radius_m;
    out.at_infinity = at_infinity;
    return out;
}

/// A pencil in focus at a metre; half_k: spherical aberration that folds it.
StopPencil pencil(double half_k_per_m) {
    return {V2d(0.1, -0.05), 0.05, half_k_per_m, 1 / 0.05 - 1, 0.02};
}

V2f random2(uint32_t i, uint32_t purpose) {
    return {to_unit_float(hash32(hash32(i, purpose), 0)), to_unit_float(hash32(hash32(i, purpose), 1))};
}

// The density integrates to the share of draws that reach a point of the stop: as a mean over the
// stop, against how often aim() finds one.
TEST(Targets, DensitiesAreThoseOfTheDraws) {
    int folded = 0;
    for (const double k : {0., 8., 40.})
        for (const double z : {-0.6, -0.95, -1.4, -4.})
            for (const bool at_infinity : {false, true}) {
                const StopPencil rays = pencil(k);
                const V3d d = rays.direction(V2d(0.006, 0.004));
                const V3d at = V3d(0.006, 0.004, 0) + d * -z;
                const LocalTarget target =
                    at_infinity ? local(d, 0.003, true) : local(at, 0.002 * -z);
                test::Moments density, found;
                for (uint32_t i = 0; i < 40'000; ++i) {
                    const V2d s = V2d(uniform_disk(random2(i, 1))) * rays.reach_m;
                    density.add(aimed_density(rays, target, s) * 3.14159265 * rays.reach_m *
                                rays.reach_m);
                    const auto aimed = aim(rays, target, random2(i, 2), random2(i, 3).x);
                    const bool inside = aimed && aimed->length() <= rays.reach_m;
                    found.add(inside);
                    if (inside) EXPECT_GT(aimed_density(rays, target, *aimed * 0.9999999), 0) << i;
                }
                folded += found.mean() < 0.9;
                const Mean apart = Mean(density) - Mean(found);
                EXPECT_TRUE(test::agrees(apart, 0))
                    << k << ' ' << z << ' ' << at_infinity << ": " << Mean(density) << ", "
                    << Mean(found);
            }
    EXPECT_GT(folded, 0);
}

/// Light that a test puts in the scene: a lamp of some mm out of focus before a soft background.
float light_along(const Ray& ray, const V3f& lamp, float radius_m) {
    const V3f to = lamp - ray.origin;
    const float along = to.dot(ray.direction);
    const bool met = along > 0 && (to - along * ray.direction).length2() < radius_m * radius_m;
    return (met ? 300.f : 0.f) + 1 + ray.direction.x;
}

/// Mean of a camera's estimates for one pixel, with and without rays to targets.
struct Means {
    test::Moments ordinary, both;
};
Means means(const Camera& camera, const Observer& observer, const V3f& lamp, float radius_m,
            std::span<const ListedTarget> targets) {
    Means out;
    const Filter filter(FilterKind::Box, 0.5f);
    const V2f size(320, 200);
    for (uint32_t i = 0; i < 20'000; ++i) {
        const Sampler sampler(SamplerKind::Independent, 3, {7, 9, i});
        const Bands bands = observer.spectral() ? observer.draw(sampler.get1(Dim::Wavelength))
                                                : Bands::rgb();
        const V2f offset = filter.sample(sampler.get2(Dim::Film));
        const FilmPoint at{V2f(0.5f) + offset / size, sampler, {&filter, offset, size}};
        double whole = 0, shared = 0;
        const auto add = [&](const CameraPath& path) {
            const double light = double(hsum(path.weight)) * light_along(path.ray, lamp, radius_m);
            whole += light;
            shared += light * double(path.share);
        };
        for (const CameraPath& path : camera.sample(at, bands)) add(path);
        out.ordinary.add(whole);
        for (const CameraPath& path : camera.aimed(at, bands, targets)) add(path);
        out.both.add(shared);
    }
    return out;
}

std::shared_ptr<TargetGrid> one_list(std::vector<Target> targets) {
    auto out = std::make_shared<TargetGrid>();
    out->cells = {1, 1};
    out->lists.emplace_back();
    float sum = 0;
    for (size_t i = 0; i < targets.size(); ++i) sum += float(i + 1);
    for (size_t i = 0; i < targets.size(); ++i)
        out->lists[0].push_back({targets[i], float(i + 1) / sum});
    return out;
}

/// Targets of the right place and size, and wrong ones: the mean must be the same with all.
/// pays: the lamp is much smaller than the circle of confusion around it.
void expect_same_mean(Camera& camera, const Observer& observer, float distance_m, float radius_m,
                      bool pays) {
    const Pose pose(kPose);
    const V3f lamp = pose.origin + pose.to_world(V3f(0.005f, 0.004f, -1) * distance_m);
    const V3f axis = unit(lamp - pose.origin);
    const auto disc = [&](const V3f& beside, float radius_m) {
        return Target{lamp + beside, axis, radius_m, false};
    };
    const V3f off = pose.right * (0.75f * radius_m);
    const std::vector<std::vector<Target>> cases{
        {disc(V3f(0.f), radius_m)},
        {disc(V3f(0.f), radius_m / 3)},
        {disc(V3f(0.f), radius_m * 5)},
        {disc(off, radius_m), disc(-off, radius_m / 2), disc(off + axis * 0.2f, radius_m)},
        {{axis, axis, 0.003f, true}, disc(pose.up * 0.5f, radius_m)}};
    double least = INFINITY, plain = 0;
    for (size_t i = 0; i < cases.size(); ++i) {
        camera.set_targets(one_list(cases[i]));
        const Means found = means(camera, observer, lamp, radius_m, camera.targets()->lists[0]);
        // They share their ordinary rays, so this allows a little more than chance does.
        EXPECT_TRUE(test::agrees(Mean(found.both) - Mean(found.ordinary), 0))
            << i << ": " << Mean(found.both) << ", " << Mean(found.ordinary);
        least = std::min(least, found.both.standard_error());
        plain = found.ordinary.standard_error();
    }
    if (pays) EXPECT_LT(least, plain / 3) << "the right target pays";
}

TEST(Targets, ThinLensKeepsItsMean) {
    for (const float distance_m : {0.6f, 4.f}) {
        ThinLens lens{kPose, 0.5f, 1.6f, Iris(ApertureShape(), 20), 1.f};
        lens.vignetting.emplace(50, 1);
        ThinLensCamera camera(lens);
        expect_same_mean(camera, Observer(), distance_m, 0.004f, distance_m > 1);
    }
}

// Strongly aberrated, so that the pencil folds near its caustic, with each way of wavelengths.
TEST(Targets, SingletKeepsItsMean) {
    const Glass glass{"crown", IndexTable{{{400, 1.53}, {587, 1.517}, {700, 1.513}}}};
    for (const auto mode : {DispersionMode::Shared, DispersionMode::Split, DispersionMode::Hero})
        for (const float distance_m : {0.7f, 0.9f, 3.f}) {
            AberratedLens lens{kPose,   Singlet::bent(glass, 50, 0.8),
                               Iris(ApertureShape(), 9), 1, 0.5f, 1.6f, mode};
            AberratedLensCamera camera(lens);
            expect_same_mean(camera, test::plain_observer(), distance_m, 0.001f, distance_m > 1);
        }
}

}  // namespace
}  // namespace petzval
