// SPDX-License-Identifier: Apache-2.0
// What a material is at a hit: factors times textures, and the layers that glTF's extensions add.
#include <algorithm>
#include <optional>

#include "core/scene/motion.h"
#include "core/shading/surface.h"

namespace petzval {
namespace {

// It is called for every texture of every hit, so that a call would show.
[[gnu::always_inline]] inline TextureLookup locate(const Scene& scene, const Surface& s,
                                                   const TextureSlot& slot) {
    const V2f uv = slot.uv_set < s.uv.size()
                       ? s.uv[slot.uv_set]
                       : s.mesh->uv_at(s.hit.triangle, s.hit.barycentric, slot.uv_set);
    return locate_texture(scene.images, slot, uv);
}

f4 read(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    return read_texture(locate(scene, s, slot));
}

Rgb read_rgb(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    f4 texel = read(scene, s, slot);
    texel[3] = 0.f;
    return Rgb(texel);
}

// The part of the mesh's tangent across the normal, and the bitangent, on the front side; nothing
// where the tangent has no such part.
struct Tangents {
    V3f tangent, bitangent;
};
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

// The normal map's normal in the frame that the tangents span, on the front side.
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

// The shading normal on wo's side; n is on the front side, and from a map if it says so.
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

// Index of what fills space, null for air. Thin materials do not bend, whatever their glass. A
// facet between equal indices has no half vector: what hardly differs from air differs by a
// thousandth, which bends nothing that shows.
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

/// Reads the layers that most materials lack.
class Layers {
  public:
    Layers(const Scene& scene, const Surface& s, const V3f& wo, const Bands& bands)
        : scene_(scene), s_(s), m_(*s.material), wo_(wo), bands_(bands) {}

    [[nodiscard]] float coat_weight() const { return m_.coat * channel(m_.coat_texture, 0); }

    // Without a map of its own the coat has the mesh's normal, whatever the base's map.
    void read_coat(const Frame& frame, CoatInput& coat) const {
        if (!(m_.coat > 0.f)) return;
        coat.weight = coat_weight();
        coat.roughness = m_.coat_roughness * channel(m_.coat_roughness_texture, 1);
        const TextureSlot& map = m_.coat_normal_texture;
        const bool mapped = map.present() && !s_.mesh->tangents.empty();
        if (!mapped && !m_.normal_texture.present()) return;
        const V3f n = mapped
                          ? mapped_normal(scene_, s_, locate(scene_, s_, map), m_.coat_normal_scale)
                          : s_.ns;
        coat.normal = unit(frame.to_local(shading_normal(s_, n, mapped, wo_)));
        if (coat.normal.z > kSameNormal) coat.normal = V3f(0, 0, 1);
    }

    void read_sheen(BsdfInput& b) const {
        if (!m_.has_sheen()) return;
        const Rgb colour = m_.sheen_color * read_rgb(scene_, s_, m_.sheen_color_texture);
        b.sheen = uplift_reflectance(colour, bands_);
        b.sheen_most = hmax(colour.v);
        b.sheen_roughness = m_.sheen_roughness * channel(m_.sheen_roughness_texture, 3);
    }

    // Turns the frame's x along the wide lobe.
    void read_anisotropy(Frame& frame, BsdfInput& b) const {
        if (!(m_.anisotropy > 0.f)) return;
        b.anisotropy = m_.anisotropy;
        V2f along(std::cos(m_.anisotropy_rotation_rad), std::sin(m_.anisotropy_rotation_rad));
        if (m_.anisotropy_texture.present()) {
            const f4 texel = read(scene_, s_, m_.anisotropy_texture);
            b.anisotropy *= texel[2];
            const V2f direction(texel[0] * 2.f - 1.f, texel[1] * 2.f - 1.f);
            along = V2f(along.x * direction.x - along.y * direction.y,
                        along.x * direction.y + along.y * direction.x);
        }
        if (s_.mesh->tangents.empty()) return;
        if (const auto t = tangents_at(scene_, s_))
            frame = Frame::about(frame.z, t->tangent * along.x + t->bitangent * along.y);
    }

    // outside and front: what lies outside the material, and before the surface; null for air.
    void read_film(const Material* outside, const Material* front, BsdfInput& b) const {
        if (!(m_.iridescence > 0.f)) return;
        b.film_share = m_.iridescence * channel(m_.iridescence_texture, 0);
        b.film_index = m_.film_ior / index_of(outside, Bands::rgb())[0];
        // Diffuse light goes in at all angles, and none of them may keep it in for ever.
        if (m_.diffuse_transmission > 0.f) b.film_index = std::max(b.film_index, 1.f);
        b.film_index_on_glass = m_.film_ior / index_of(front, Bands::rgb())[0];
        b.film_thickness_nm =
            lerp(m_.film_thinnest_nm, m_.film_thickest_nm, channel(m_.film_thickness_texture, 1));
        if (!(b.film_thickness_nm > 0.f)) b.film_share = 0.f;
    }

    void read_diffuse_transmission(BsdfInput& b) const {
        if (!(m_.diffuse_transmission > 0.f)) return;
        b.diffuse_transmission =
            m_.diffuse_transmission * channel(m_.diffuse_transmission_texture, 3);
        b.diffuse_transmission_color =
            uplift_reflectance(m_.diffuse_transmission_color *
                                   read_rgb(scene_, s_, m_.diffuse_transmission_color_texture),
                               bands_);
    }

  private:
    [[nodiscard]] float channel(const TextureSlot& slot, int of) const {
        return slot.present() ? read(scene_, s_, slot)[of] : 1.f;
    }

    const Scene& scene_;
    const Surface& s_;
    const Material& m_;
    const V3f& wo_;
    const Bands& bands_;
};

}  // namespace

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
    const Layers layers(scene, s, wo, bands);
    if (layered) layers.read_anisotropy(out.frame, out.bsdf);
    if (out.frame.z.dot(s.side) < kSameNormal) out.up = out.frame.to_local(s.side);
    if (lookups.emits) {
        f4 texel = read_texture(lookups.emissive);
        texel[3] = 0.f;
        out.emitted = m.emissive * Rgb(texel);
        if (m.beam) out.emitted = out.emitted * m.beam->falloff(wo.dot(m.beam->direction));
    }
    if (m.coat > 0.f && lookups.emits)
        out.emitted = out.emitted * past_coat(layers.coat_weight(), std::fabs(wo.dot(s.ng)));
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
