// SPDX-License-Identifier: Apache-2.0
// Layers beside the picture (AOVs), of the surface that a sample sees first.
#pragma once

#include "core/film/film.h"
#include "core/shading/surface.h"

namespace petzval {

/// Fills the layers of a sample from its first surface.
inline void record_layers(const Surface& s, const ShadingInput& shading, Rgb emission,
                          const V3f& camera, const V3f& wo, const Bands& bands, FilmSample& out) {
    const auto layer = [&](Aov aov) -> V3f& { return out.aov[static_cast<size_t>(aov)]; };
    const auto vector = [](Rgb c) { return V3f(c[0], c[1], c[2]); };
    const CoatedBsdf bsdf = shading.scatter(wo, bands);
    out.hit = true;
    out.first = s.hit;
    layer(Aov::Albedo) =
        vector(s.material->unlit ? shading.unlit : reflectance_to_rgb(bsdf.albedo(), bands));
    layer(Aov::Normal) = shading.frame.z;
    layer(Aov::Depth) = V3f((s.p - camera).length(), 0, 0);
    layer(Aov::Position) = s.p;
    layer(Aov::Uv) = V3f(s.uv[0].x, s.uv[0].y, 0);
    layer(Aov::Emission) = vector(emission);
    layer(Aov::Velocity) = V3f(0.f);  // where nobody tells it
}

}  // namespace petzval
