// SPDX-License-Identifier: Apache-2.0
// Mean radiance over bundles of paths, with its error.
#pragma once

#include <gtest/gtest.h>

#include "core/spectrum/colour.h"
#include "integrator/path/path.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace petzval::test {

// Mean red radiance over a bundle of rays; the error comes from 32 independent replicates, as the
// points of one replicate are not independent.
template <class MakeRay>
Mean estimate(const World& world, const integrator::PathOptions& options, uint32_t samples,
              const MakeRay& make_ray, float* alpha = nullptr) {
    constexpr int replicates = 32;
    const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights, options);
    integrator::PathStats stats;
    Moments means;
    for (uint32_t seed = 0; seed < replicates; ++seed) {
        double mean = 0;
        for (uint32_t i = 0; i < samples; ++i) {
            const Sampler sampler(SamplerKind::Owen, seed, {3, 5, i});
            FilmSample out;
            mean += tracer.radiance({make_ray(sampler.get2(Dim::Film))}, Bands::rgb(), sampler, out,
                                    stats)[0];
            if (alpha) *alpha += out.alpha / static_cast<float>(samples * replicates);
        }
        means.add(mean / samples);
    }
    return means;
}

/// Holds that light samples alone and BSDF samples alone give the mean of both together, each with
/// a relative error below most_error. Returns the mean of both.
template <class MakeRay>
Mean expect_techniques_agree(const World& world, integrator::PathOptions options, uint32_t samples,
                             const MakeRay& make_ray, double most_error) {
    const auto by = [&](integrator::Technique technique) {
        options.technique = technique;
        return estimate(world, options, samples, make_ray);
    };
    const Mean both = by(integrator::Technique::Mis);
    for (const integrator::Technique technique :
         {integrator::Technique::LightOnly, integrator::Technique::BsdfOnly}) {
        const Mean one = by(technique);
        EXPECT_TRUE(agrees(both - one, 0)) << both << " and " << one;
        EXPECT_LT(one.error, most_error * one.value);
    }
    return both;
}

inline Ray ray_to(V3f origin, V3f target) {
    Ray ray;
    ray.origin = origin;
    ray.direction = unit(target - origin);
    return ray;
}

// A bundle over the square [-0.5, 0.5]^2 at z = 0, seen from z = 4.
inline Ray bundle(V2f u) {
    return ray_to(V3f(0, 0, 4), V3f(u.x - 0.5f, u.y - 0.5f, 0));
}

// Sums of floats allow 1e-5 beside chance; chance is small, so that the test has teeth.
inline void expect_agrees(const Mean& e, double truth, const char* what) {
    EXPECT_TRUE(agrees(e, truth, 1e-5 * truth)) << what << ": " << e << ", not " << truth;
    EXPECT_LT(e.error, 0.005 * truth) << what;
}

}  // namespace petzval::test
