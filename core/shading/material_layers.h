// SPDX-License-Identifier: Apache-2.0
// Layers that glTF's extensions add to a material and most lack, and the readers of textures and
// normals that they share with the rest of it (read_material.cpp).
#pragma once

#include <optional>

#include "core/shading/surface.h"

namespace petzval::material_reading {

[[nodiscard]] TextureLookup located(const Scene&, const Surface&, const TextureSlot&);
[[nodiscard]] f4 read(const Scene&, const Surface&, const TextureSlot&);
[[nodiscard]] Rgb read_rgb(const Scene&, const Surface&, const TextureSlot&);
/// The part of the mesh's tangent across the normal, and the bitangent, on the front side.
struct Tangents {
    V3f tangent, bitangent;
};
/// Tangents at a hit; nothing where the mesh's has no part across the normal.
[[nodiscard]] std::optional<Tangents> tangents_at(const Scene&, const Surface&);
/// Normal of a map in the frame that the tangents span, on the front side.
[[nodiscard]] V3f mapped_normal(const Scene&, const Surface&, const TextureLookup& map,
                                float scale);
/// Shading normal on wo's side; n is on the front side, and from a map if it says so.
[[nodiscard]] V3f shading_normal(const Surface&, const V3f& n, bool mapped, const V3f& wo);
/// Index of what fills space, null for air. Thin materials do not bend, whatever their glass. A
/// facet between equal indices has no half vector: what hardly differs from air differs by a
/// thousandth, which bends nothing that shows.
[[nodiscard]] f4 index_of(const Material*, const Bands&);

/// Reads the layers of a material at a hit.
struct Layers {
    const Scene& scene;
    const Surface& s;
    const Material& m;
    const V3f& wo;
    const Bands& bands;

    [[nodiscard]] float coat_weight() const;
    /// Without a map of its own the coat has the mesh's normal, whatever the base's map.
    void read_coat(const Frame&, CoatInput&) const;
    void read_sheen(BsdfInput&) const;
    /// Turns the frame's x along the wide lobe.
    void read_anisotropy(Frame&, BsdfInput&) const;
    /// outside and front: what lies outside the material, and before the surface; null for air.
    void read_film(const Material* outside, const Material* front, BsdfInput&) const;
    void read_diffuse_transmission(BsdfInput&) const;

  private:
    /// A channel of a texture at the hit; 1 where there is none.
    [[nodiscard]] float channel(const TextureSlot&, int of) const;
};

}  // namespace petzval::material_reading
