// SPDX-License-Identifier: Apache-2.0
#include "core/shading/material_layers.h"

#include <algorithm>

namespace petzval::material_reading {

float Layers::channel(const TextureSlot& slot, int of) const {
    return slot.present() ? read(scene, s, slot)[of] : 1.f;
}

float Layers::coat_weight() const {
    return m.coat * channel(m.coat_texture, 0);
}

void Layers::read_coat(const Frame& frame, CoatInput& coat) const {
    if (!(m.coat > 0.f)) return;
    coat.weight = coat_weight();
    coat.roughness = m.coat_roughness * channel(m.coat_roughness_texture, 1);
    const TextureSlot& map = m.coat_normal_texture;
    const bool mapped = map.present() && !s.mesh->tangents.empty();
    if (!mapped && !m.normal_texture.present()) return;
    const V3f n =
        mapped ? mapped_normal(scene, s, located(scene, s, map), m.coat_normal_scale) : s.ns;
    coat.normal = unit(frame.to_local(shading_normal(s, n, mapped, wo)));
    if (coat.normal.z > kSameNormal) coat.normal = V3f(0, 0, 1);
}

void Layers::read_sheen(BsdfInput& b) const {
    if (!m.has_sheen()) return;
    const Rgb colour = m.sheen_color * read_rgb(scene, s, m.sheen_color_texture);
    b.sheen = uplift_reflectance(colour, bands);
    b.sheen_most = hmax(colour.v);
    b.sheen_roughness = m.sheen_roughness * channel(m.sheen_roughness_texture, 3);
}

void Layers::read_anisotropy(Frame& frame, BsdfInput& b) const {
    if (!(m.anisotropy > 0.f)) return;
    b.anisotropy = m.anisotropy;
    V2f along(std::cos(m.anisotropy_rotation_rad), std::sin(m.anisotropy_rotation_rad));
    if (m.anisotropy_texture.present()) {
        const f4 texel = read(scene, s, m.anisotropy_texture);
        b.anisotropy *= texel[2];
        const V2f direction(texel[0] * 2.f - 1.f, texel[1] * 2.f - 1.f);
        along = V2f(along.x * direction.x - along.y * direction.y,
                    along.x * direction.y + along.y * direction.x);
    }
    if (s.mesh->tangents.empty()) return;
    if (const auto t = tangents_at(scene, s))
        frame = Frame::about(frame.z, t->tangent * along.x + t->bitangent * along.y);
}

void Layers::read_film(const Material* outside, const Material* front, BsdfInput& b) const {
    if (!(m.iridescence > 0.f)) return;
    b.film_share = m.iridescence * channel(m.iridescence_texture, 0);
    b.film_index = m.film_ior / index_of(outside, Bands::rgb())[0];
    // Diffuse light goes in at all angles, and none of them may keep it in for ever.
    if (m.diffuse_transmission > 0.f) b.film_index = std::max(b.film_index, 1.f);
    b.film_index_on_glass = m.film_ior / index_of(front, Bands::rgb())[0];
    b.film_thickness_nm =
        lerp(m.film_thinnest_nm, m.film_thickest_nm, channel(m.film_thickness_texture, 1));
    if (!(b.film_thickness_nm > 0.f)) b.film_share = 0.f;
}

void Layers::read_diffuse_transmission(BsdfInput& b) const {
    if (!(m.diffuse_transmission > 0.f)) return;
    b.diffuse_transmission = m.diffuse_transmission * channel(m.diffuse_transmission_texture, 3);
    b.diffuse_transmission_color = uplift_reflectance(
        m.diffuse_transmission_color * read_rgb(scene, s, m.diffuse_transmission_color_texture),
        bands);
}

}  // namespace petzval::material_reading
