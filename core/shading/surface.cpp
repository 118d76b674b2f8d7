// SPDX-License-Identifier: Apache-2.0
#include "core/shading/surface.h"

#include <algorithm>

namespace petzval {
namespace {

// Cosine between normals that are the same but for rounding, or for the eye.
constexpr float kSameNormal = 1.f - 1e-6f;

V3f abs_transform(const V3f& p, const M44f& m) {
    V3f sum;
    for (int j = 0; j < 3; ++j)
        sum[j] = std::fabs(p.x * m[0][j]) + std::fabs(p.y * m[1][j]) + std::fabs(p.z * m[2][j]) +
                 std::fabs(m[3][j]);
    return sum;
}

// Unnormalised normal in world space, by the inverse transpose; to_local is the inverse.
V3f transform_normal(const V3f& n, const M44f& to_local) {
    return {n.x * to_local[0][0] + n.y * to_local[0][1] + n.z * to_local[0][2],
            n.x * to_local[1][0] + n.y * to_local[1][1] + n.z * to_local[1][2],
            n.x * to_local[2][0] + n.y * to_local[2][1] + n.z * to_local[2][2]};
}

V3f transform_direction(const V3f& v, const M44f& m) {
    V3f out;
    m.multDirMatrix(v, out);
    return out;
}

TextureLookup locate(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    return locate_texture(scene.images, slot, s.uv[slot.uv_set]);
}

f4 read(const Scene& scene, const Surface& s, const TextureSlot& slot) {
    return read_texture(locate(scene, s, slot));
}

// The normal map's normal in the frame that the tangents span, on the front side.
V3f mapped_normal(const Surface& s, const TextureLookup& map) {
    const Material& m = *s.material;
    const V4f t4 =
        interpolate(s.mesh->tangents, s.mesh->triangles[s.hit.triangle], s.hit.barycentric);
    V3f t(t4.x, t4.y, t4.z);
    if (!s.instance->identity) t = transform_direction(t, s.instance->to_world);
    t -= s.ns * t.dot(s.ns);
    if (t.dot(t) < 1e-20f) return s.ns;
    t = unit(t);
    const float flip = s.instance->flips ? -1.f : 1.f;
    const V3f bitangent = s.ns.cross(t) * (t4.w < 0.f ? -flip : flip);
    const f4 texel = read_texture(map) * 2.f - 1.f;
    const V3f n =
        t * (texel[0] * m.normal_scale) + bitangent * (texel[1] * m.normal_scale) + s.ns * texel[2];
    return n.dot(n) > 1e-12f ? unit(n) : s.ns;
}

// Shading normal that wo sees from the front. One seen from behind would reflect into the surface:
// it is tilted until wo grazes it.
V3f face_towards(const V3f& n, const V3f& wo) {
    constexpr float least_cosine = 1e-3f;
    const float cosine = n.dot(wo);
    return cosine >= least_cosine ? n : unit(n + wo * (least_cosine - cosine));
}

// Way from a point of a triangle to the smooth surface that its corners' normals mean, in the
// mesh's own space: the mean of the point's projections on the tangent planes of the corners, where
// those lie above it. Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4.
// Normals far from the triangle's are those of a hard edge that was smoothed by mistake, and mean
// no surface. n: the triangle's, any length.
V3f way_to_smooth(const Mesh& mesh, const std::array<uint32_t, 3>& corner, V2f u, const V3f& p,
                  const V3f& n, bool front) {
    constexpr float all = 0.766f, none = 0.643f;  // cosines of 40 and 50 degrees
    const float weight[3] = {1.f - u.x - u.y, u.x, u.y};
    const V3f triangle = n * (1.f / std::sqrt(n.dot(n)));
    V3f sum(0.f);
    for (size_t i = 0; i < 3; ++i) {
        const V3f& normal = mesh.normals[corner[i]];
        const float above = (p - mesh.positions[corner[i]]).dot(normal);
        if (front ? !(above < 0.f) : !(above > 0.f)) continue;
        const float share = clamp_unit((normal.dot(triangle) - none) / (all - none));
        sum -= normal * (above * weight[i] * share);
    }
    return sum;
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

bool disperses(const Material* m, const Bands& bands) {
    return m && bands.spectral && m->glass && m->has_volume;
}

}  // namespace

Surface make_surface(const Scene& scene, const V3f& direction, const Hit& hit) {
    Surface s;
    s.hit = hit;
    s.instance = &scene.instances[hit.instance];
    s.mesh = &scene.meshes[s.instance->mesh];
    s.material = &scene.materials[s.mesh->material];
    const auto& corner = s.mesh->triangles[hit.triangle];
    const V3f& a = s.mesh->positions[corner[0]];
    const V3f& b = s.mesh->positions[corner[1]];
    const V3f& c = s.mesh->positions[corner[2]];
    const V2f u = hit.barycentric;
    const float w = 1.f - u.x - u.y;
    s.p = a * w + b * u.x + c * u.y;
    // Seven roundings from the corners to p; Embree's own coordinates add as many again.
    s.p_error = (abs(a) * std::fabs(w) + abs(b) * u.x + abs(c) * u.y) * rounding_bound(14);
    V3f n = (b - a).cross(c - a);
    const V3f p_of_mesh = s.p, n_of_mesh = n;
    const bool smooth = !s.mesh->normals.empty();
    V3f ns = smooth ? interpolate(s.mesh->normals, corner, u) : n;
    if (!s.instance->identity) {
        const M44f& m = s.instance->to_world;
        const V3f magnitude = abs_transform(s.p, m);
        M44f linear = m;
        for (int j = 0; j < 3; ++j) linear[3][j] = 0;
        s.p_error = abs_transform(s.p_error, linear) + magnitude * rounding_bound(8);
        V3f moved;
        m.multVecMatrix(s.p, moved);
        s.p = moved;
        n = transform_normal(n, s.instance->to_local);
        ns = smooth ? transform_normal(ns, s.instance->to_local) : n;
    }
    s.ng = unit(n);
    const float length2 = ns.dot(ns);
    s.ns = length2 > 0.f ? ns * (1.f / std::sqrt(length2)) : s.ng;
    if (s.ns.dot(s.ng) < 0.f) s.ns = -s.ns;
    s.front = direction.dot(s.ng) < 0.f;
    s.side = s.facing();
    s.lift = V3f(0.f);
    if (smooth && s.material->transmission == 0.f && s.ns.dot(s.ng) < kSameNormal) {
        const V3f towards = s.front ? s.ns : -s.ns;
        if (direction.dot(towards) < 0.f)
            s.lift = way_to_smooth(*s.mesh, corner, u, p_of_mesh, n_of_mesh, s.front);
        if (s.lifted()) {
            s.side = towards;
            if (!s.instance->identity) s.lift = transform_direction(s.lift, s.instance->to_world);
        }
    }
    for (int i = 0; i < 2; ++i)
        if (!s.mesh->uv[i].empty()) s.uv[i] = interpolate(s.mesh->uv[i], corner, u);
    return s;
}

f4 vertex_colour(const Surface& s) {
    if (s.mesh->colours.empty()) return splat(1.f);
    const V4f c =
        interpolate(s.mesh->colours, s.mesh->triangles[s.hit.triangle], s.hit.barycentric);
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
    f4 base = m.base_color.v * read_texture(lookups.base_color);
    if (!s.mesh->colours.empty()) base *= vertex_colour(s);
    base[3] = 0.f;
    const Rgb base_color(base);
    V3f n = s.ns;
    if (m.normal_texture.present() && !s.mesh->tangents.empty())
        n = mapped_normal(s, lookups.normal);
    out.frame = Frame::about(face_towards(s.front ? n : -n, wo));
    if (out.frame.z.dot(s.side) < kSameNormal) out.up = out.frame.to_local(s.side);
    if (lookups.emits) {
        f4 texel = read_texture(lookups.emissive);
        texel[3] = 0.f;
        out.emitted = m.emissive * Rgb(texel);
    }
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
    const f4 surface_texel = read_texture(lookups.metallic_roughness);
    b.roughness = m.roughness * surface_texel[1];
    b.metallic = m.metallic * surface_texel[2];
    float specular = m.specular;
    if (m.specular_texture.present()) specular *= read(scene, s, m.specular_texture)[3];
    Rgb specular_color = m.specular_color;
    if (m.specular_color_texture.present()) {
        f4 texel = read(scene, s, m.specular_color_texture);
        texel[3] = 0.f;
        specular_color = specular_color * Rgb(texel);
    }
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
    return out;
}

f4 transmittance(const Material& m, float distance_m, const Bands& bands) {
    const float distances = distance_m / m.attenuation_distance_m;
    if (!(distances > 0.f)) return uniform(1.f, bands);
    f4 share = uplift_reflectance(m.attenuation_color, bands);
    for (int i = 0; i < 4; ++i) share[i] = std::pow(share[i], distances);
    return share;
}

}  // namespace petzval
