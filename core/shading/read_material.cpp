// SPDX-License-Identifier: Apache-2.0
// What a material is at a hit: factors times textures.
#include <algorithm>

#include "core/scene/motion.h"
#include "core/shading/material_layers.h"

namespace petzval {
namespace material_reading {

// It is called for every texture of every hit, so that a call would show.
[[gnu::always_inline]] inline TextureLookup locate(const Scene& scene, const Surface& s,
                                                   const TextureSlot& slot) {
    const V2f uv = slot.uv_set < s.uv.size()
                       ? s.uv[slot.uv_set]
                       : s.mesh->uv_at(s.hit.triangle, s.hit.barycentric, slot.uv_set);
    return locate_texture(scene.images, slot, uv);
}

TextureLookup located(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    return locate(scene, s, slot);
}

f4 read(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    return read_texture(locate(scene, s, slot));
}

Rgb read_rgb(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    f4 texel = read(scene, s, slot);
    texel[3] = 0.f;
    return Rgb(texel);
}

std::optional<Tangents> tangents_at(const Scene& scene, const Surface& s) {
    const V4f t4 = tangent_at(*s.mesh, s.hit.triangle, s.hit.barycentric, s.hit.time);
    V3f t(t4.x, t4.y, t4.z);
    bool flips = false;
    if (!s.instance->identity)
        with_instance_at(scene, s.hit.instance, s.hit.time, [&](const Instance& placement) {
            t = transform_direction(t, placement.to_world);
            flips = placement.flips;
        });
    t -= s.ns * t.dot(s.ns);
    if (t.dot(t) < 1e-20f) return std::nullopt;
    t = unit(t);
    const float flip = flips ? -1.f : 1.f;
    return Tangents{t, s.ns.cross(t) * (t4.w < 0.f ? -flip : flip)};
}

V3f mapped_normal(const Scene& scene, const Surface& s, const TextureLookup& map, float scale) {
    const auto t = tangents_at(scene, s);
    if (!t) return s.ns;
    const f4 texel = read_texture(map) * 2.f - 1.f;
    const V3f n =
        t->tangent * (texel[0] * scale) + t->bitangent * (texel[1] * scale) + s.ns * texel[2];
    return n.dot(n) > 1e-12f ? unit(n) : s.ns;
}

// Shading normal that wo sees from the front. One seen from behind would reflect into the surface:
// it is tilted until wo grazes it.
V3f face_towards(const V3f& n, const V3f& wo) {
    constexpr float least_cosine = 1e-3f;
    const float cosine = n.dot(wo);
    return cosine >= least_cosine ? n : unit(n + wo * (least_cosine - cosine));
}

// Normal of a map, turned towards the surface's own, `up`, until the mirror image of wo about it
// just leaves the surface. In the plane of the two, where the normal stands at an angle t from `up`
// and wo has the coordinates a along it and b along `up`, the image's height is a sin 2t + b cos
// 2t. Both normals lie on wo's side.
V3f reflect_outwards(const V3f& n, const V3f& up, const V3f& wo) {
    constexpr float least_height = 0.01f;
    const float b = wo.dot(up), cosine = n.dot(up), height = std::min(least_height, 0.5f * b);
    if (2.f * n.dot(wo) * cosine - b >= height) return n;
    const V3f across = n - up * cosine;
    if (!(across.dot(across) > 1e-12f)) return up;
    const V3f x = unit(across);
    const float a = wo.dot(x), length2 = sqr(a) + sqr(b);
    const float cos2 = (b * height - a * safe_sqrt(length2 - sqr(height))) / length2;
    return unit(up * safe_sqrt(0.5f + 0.5f * cos2) + x * safe_sqrt(0.5f - 0.5f * cos2));
}

V3f shading_normal(const Surface& s, const V3f& n, bool mapped, const V3f& wo) {
    const V3f facing = face_towards(s.front ? n : -n, wo);
    return mapped ? reflect_outwards(facing, s.side, wo) : facing;
}

// Reflectance at normal incidence: KHR_materials_ior and KHR_materials_specular. outside: what lies
// before the material, or null for air.
Rgb dielectric_f0(const Material& m, const Material* outside, Rgb specular_color, float specular) {
    const float n = outside && outside->ior != 0.f ? outside->ior : 1.f;
    const float root = m.ior == 0.f ? 1.f : (m.ior - n) / (m.ior + n);
    const Rgb f0 = specular_color * sqr(root);
    return Rgb(min(f0.v, splat(1.f))) * specular;
}

f4 index_of(const Material* m, const Bands& bands) {
    if (!m) return splat(1.f);
    const f4 index = bands.spectral && m->glass && m->has_volume
                         ? m->glass->index(bands.nm)
                         : splat(m->ior == 0.f ? 1.f : m->ior);
    const f4 bend = index - 1.f;
    return max(bend, -bend) < 1e-3f ? splat(1.001f) : index;
}

// Replaces the diffuse colour and the roughness by those of KHR_materials_pbrSpecularGlossiness:
// c_diff = diffuse (1 - max(specular)), alpha = (1 - glossiness)^2.
void read_glossiness(const Scene& scene, const Surface& s, Rgb specular, BsdfInput& b) {
    const Material& m = *s.material;
    const TextureSlot& slot = m.specular_color_texture;
    const float texel = slot.present() ? read(scene, s, slot)[3] : 1.f;
    b.roughness = 1.f - (1.f - m.roughness) * texel;
    const float most = std::max({specular[0], specular[1], specular[2]});
    b.base_color *= 1.f - most;
}

bool disperses(const Material* m, const Bands& bands) {
    return m && bands.spectral && m->glass && m->has_volume;
}

}  // namespace material_reading

using namespace material_reading;

f4 vertex_colour(const Surface& s) {
    if (s.mesh->colours.empty()) return splat(1.f);
    const V4f c = s.mesh->colour_at(s.hit.instance, s.hit.triangle, s.hit.barycentric);
    return f4{c.x, c.y, c.z, c.w};
}

MaterialLookups locate_material(const Scene& scene, const Surface& s) {
    const Material& m = *s.material;
    MaterialLookups out;
    out.base_color = locate(scene, s, m.base_color_texture);
    const auto locate_next = [&](const TextureSlot& slot) {
        return slot.place != 0 && slot.place == m.base_color_texture.place
                   ? locate_beside(scene.images, slot, out.base_color)
                   : locate(scene, s, slot);
    };
    out.metallic_roughness = locate_next(m.metallic_roughness_texture);
    out.normal = locate_next(m.normal_texture);
    out.emits = m.emits() && !m.unlit && (s.front || m.double_sided);
    if (out.emits) out.emissive = locate_next(m.emissive_texture);
    return out;
}

ShadingInput read_material(const Scene& scene, const Surface& s, const MaterialLookups& lookups,
                           const V3f& wo, const Bands& bands, const Fillings& sides) {
    const Material& m = *s.material;
    ShadingInput out;
    // Where the reflectance is measured, the texture is that of a cutout: it has the holes.
    f4 base =
        m.reflectance < 0 ? m.base_color.v * read_texture(lookups.base_color) : m.base_color.v;
    if (!s.mesh->colours.empty()) base *= vertex_colour(s);
    base[3] = 0.f;
    const Rgb base_color(base);
    V3f n = s.ns;
    const bool mapped = m.normal_texture.present() && !s.mesh->tangents.empty();
    if (mapped) n = mapped_normal(scene, s, lookups.normal, m.normal_scale);
    out.frame = Frame::about(shading_normal(s, n, mapped, wo));
    const bool layered = m.layered();
    if (layered) Layers{scene, s, m, wo, bands}.read_anisotropy(out.frame, out.bsdf);
    if (out.frame.z.dot(s.side) < kSameNormal) out.up = out.frame.to_local(s.side);
    if (lookups.emits) {
        f4 texel = read_texture(lookups.emissive);
        texel[3] = 0.f;
        out.emitted = m.emissive * Rgb(texel);
        if (m.beam) out.emitted = out.emitted * m.beam->falloff(wo.dot(m.beam->direction));
    }
    if (m.coat > 0.f && lookups.emits)
        out.emitted = out.emitted * past_coat(Layers{scene, s, m, wo, bands}.coat_weight(),
                                              std::fabs(wo.dot(s.ng)));
    if (m.unlit) {
        out.unlit = base_color;
        return out;
    }
    BsdfInput& b = out.bsdf;
    b.base_color = uplift_reflectance(base_color, bands);
    if (m.metal >= 0 && bands.spectral) {
        const Metal& metal = scene.metals[static_cast<size_t>(m.metal)];
        b.measured_metal = true;
        b.metal_n = metal.n.at(bands.nm);
        b.metal_k = metal.k.at(bands.nm);
    }
    if (m.reflectance >= 0 && bands.spectral) {
        const f4 c = vertex_colour(s);
        b.base_color = uplift_reflectance({c[0], c[1], c[2]}, bands) *
                       scene.reflectances[static_cast<size_t>(m.reflectance)].share.at(bands.nm);
    }
    const f4 surface_texel = read_texture(lookups.metallic_roughness);
    b.roughness = m.roughness * surface_texel[1];
    b.metallic = m.metallic * surface_texel[2];
    float specular = m.specular;
    if (m.specular_texture.present()) specular *= read(scene, s, m.specular_texture)[3];
    Rgb specular_color = m.specular_color;
    if (m.specular_color_texture.present())
        specular_color = specular_color * read_rgb(scene, s, m.specular_color_texture);
    const Material* outside = &m == sides.before ? sides.behind : sides.before;
    b.dielectric_f0 =
        uplift_reflectance(dielectric_f0(m, outside, specular_color, specular), bands);
    b.dielectric_f90 = specular;
    b.transmission = m.transmission;
    if (m.transmission_texture.present())
        b.transmission *= read(scene, s, m.transmission_texture)[0];
    b.thin = !m.has_volume;
    b.disperses = disperses(sides.before, bands) || disperses(sides.behind, bands);
    b.eta = index_of(sides.behind, bands) / index_of(sides.before, bands);
    if (m.specular_glossiness) read_glossiness(scene, s, specular_color, b);
    if (layered) {
        const Layers layers{scene, s, m, wo, bands};
        layers.read_coat(out.frame, out.coat);
        layers.read_sheen(b);
        layers.read_film(outside, sides.before, b);
        layers.read_diffuse_transmission(b);
    }
    return out;
}

f4 transmittance(const Material& m, float distance_m, const Bands& bands) {
    const float distances = distance_m / m.attenuation_distance_m;
    if (!(distances > 0.f)) return uniform(1.f, bands);
    // Rounding must not make light grow: small distances have large powers.
    f4 share = max(min(uplift_reflectance(m.attenuation_color, bands), splat(1.f)), f4{});
    for (int i = 0; i < 4; ++i) share[i] = std::pow(share[i], distances);
    return share;
}

}  // namespace petzval
