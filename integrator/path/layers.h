// SPDX-License-Identifier: Apache-2.0
// Layers beside the picture (AOVs), of the surface that a sample sees first.
#pragma once

#include "core/film/film.h"
#include "core/shading/surface.h"

namespace petzval::integrator {

/// Surface that a sample sees first.
struct FirstSurface {
    const Surface& surface;
    const ShadingInput& shading;
    Rgb emission;
    V3f wo;  ///< unit, to where the ray came from
};

/// Fills the layers of a sample from its first surface; camera: where its ray began.
inline void record_layers(const FirstSurface& first, const V3f& camera, const Bands& bands,
                          FilmSample& out) {
    const Surface& s = first.surface;
    const ShadingInput& shading = first.shading;
    const auto layer = [&](Aov aov) -> V3f& { return out.aov[static_cast<size_t>(aov)]; };
    const auto vector = [](Rgb c) { return V3f(c[0], c[1], c[2]); };
    const CoatedBsdf bsdf = shading.scatter(first.wo, bands);
    out.hit = true;
    out.first = s.hit;
    layer(Aov::Albedo) =
        vector(s.material->unlit ? shading.unlit : reflectance_to_rgb(bsdf.albedo(), bands));
    layer(Aov::Normal) = shading.frame.z;
    layer(Aov::Depth) = V3f((s.p - camera).length(), 0, 0);
    layer(Aov::Position) = s.p;
    layer(Aov::Uv) = V3f(s.uv[0].x, s.uv[0].y, 0);
    layer(Aov::Emission) = vector(first.emission);
    layer(Aov::Velocity) = V3f(0.f);  // where nobody tells it
}

/// Fills what guides a denoiser, from the first surface that is not perfectly smooth.
inline void record_guide(const Surface& s, const V3f& normal, f4 albedo, const V3f& camera,
                         const Bands& bands, Guide& out) {
    const Rgb c = reflectance_to_rgb(albedo, bands);
    out = {true, V3f(c[0], c[1], c[2]), normal, (s.p - camera).length()};
}

}  // namespace petzval::integrator
