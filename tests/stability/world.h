// SPDX-License-Identifier: Apache-2.0
// Scenes of a few triangles for the sweeps, and how they are measured.
#pragma once

#include <memory>

#include "core/light/light_choice.h"
#include "core/scene/scene.h"
#include "core/traversal/bvh.h"
#include "integrator/path/path.h"

namespace petzval::stability {

/// A parallelogram corner + s*a + t*b; the front is where cross(a, b) points.
[[nodiscard]] Mesh quad(V3f corner, V3f a, V3f b);
/// Closed box, faces outwards.
[[nodiscard]] Mesh box(V3f low, V3f high);
/// Latitude-longitude sphere of 24 rows, flat, normals outward.
[[nodiscard]] Mesh ball(V3f centre, float radius);
/// Lambert's, seen from both sides.
[[nodiscard]] Material diffuse(float albedo);
/// A black surface that shines to both sides.
[[nodiscard]] Material glowing(float nits);
/// Clear and smooth, of that index; attenuation: share that is left after a metre.
[[nodiscard]] Material clear_glass(float ior, float attenuation = 1.f);

/// A scene and what a path tracer wants beside it.
struct World {
    Scene scene;
    std::unique_ptr<Bvh> bvh;
    std::unique_ptr<LightChoice> lights;

    void place(Mesh, const Material&);
    /// Once all is placed.
    void finish();
};

/// A square lamp of 1 nit across the view of a camera at the origin that looks along -z.
[[nodiscard]] World lamp_ahead(double side_m, double distance_m);

/// Of the red radiance along rays: mean, variance of one sample over the mean squared, and the
/// share of samples that brought any light. Rays of a sample: of the path, and to lights.
struct Measured {
    double mean = 0, relative_variance = 0, found = 0, rays = 0, shadow_rays = 0;
};

/// ray(sampler) is asked for every sample; 0 samples is an error of the caller.
template <class MakeRay>
[[nodiscard]] Measured measure(const World& world, const integrator::PathOptions& options,
                               uint32_t samples, const MakeRay& ray,
                               SamplerKind kind = SamplerKind::Independent) {
    const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights, options);
    integrator::PathStats stats;
    double sum = 0, squares = 0, found = 0;
    for (uint32_t i = 0; i < samples; ++i) {
        const Sampler sampler(kind, 1, {0, 0, i});
        FilmSample out;
        const double a =
            double(tracer.radiance({ray(sampler)}, Bands::rgb(), sampler, out, stats)[0]);
        sum += a;
        squares += a * a;
        found += a != 0;
    }
    const double mean = sum / samples;
    const auto per_sample = [&](uint64_t rays) { return static_cast<double>(rays) / samples; };
    return {mean, mean > 0 ? squares / samples / (mean * mean) - 1 : HUGE_VAL, found / samples,
            per_sample(stats.camera_rays + stats.bounce_rays), per_sample(stats.shadow_rays)};
}

}  // namespace petzval::stability
