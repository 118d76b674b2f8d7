// SPDX-License-Identifier: Apache-2.0
// Surface point on a triangle with what shading needs of it, and the material there.
#pragma once

#include "core/math/math.h"
#include "core/math/ray.h"
#include "core/scene/scene.h"
#include "core/shading/coated_bsdf.h"

namespace petzval {

/// Cosine between normals that are the same but for rounding, or for the eye.
inline constexpr float kSameNormal = 1.f - 1e-6f;

struct Surface {
    V3f p;        ///< world space, interpolated from the corners, not from t
    V3f p_error;  ///< bound on the rounding error of p in each axis
    V3f ng;       ///< unit geometric normal, on the front side
    V3f ns;       ///< unit interpolated normal, on the front side
    bool front;   ///< the ray came from the front side
    V3f side;     ///< unit, where the ray came from: reflected light leaves into its hemisphere
    V3f lift;     ///< from p to the smooth surface; 0 where `side` is the triangle's normal
    std::array<V2f, 2> uv{V2f(0.f), V2f(0.f)};  ///< (0, 0) where the mesh has none
    const Instance* instance;
    const Mesh* mesh;
    const Material* material;
    Hit hit;

    /// Unit geometric normal on the side where the ray came from.
    [[nodiscard]] V3f facing() const { return front ? ng : -ng; }
    /// Whether light leaves the smooth surface where it would meet the triangle.
    [[nodiscard]] bool lifted() const { return lift != V3f(0.f); }
    /// Point from which light leaves towards w, on the side where the ray came from: p, or the
    /// smooth surface where w leads behind the triangle.
    [[nodiscard]] V3f leaving_point(const V3f& w) const {
        return lifted() && w.dot(facing()) <= 0.f ? p + lift : p;
    }
};

/// Geometry of a hit of a ray that travels along `direction`.
[[nodiscard]] Surface make_surface(const Scene&, const V3f& direction, const Hit&);
/// Origin of a ray that leaves the surface towards w: to where the ray came from, or through it.
[[nodiscard]] inline V3f leave_surface(const Surface& s, const V3f& w, bool transmitted) {
    const V3f facing = s.facing();
    if (transmitted) return offset_origin(s.p, s.p_error, s.ng, -facing);
    return offset_origin(s.leaving_point(w), s.p_error, s.ng, facing);
}
/// Whether a camera ray goes on behind the hit: on the back of a single-sided surface, which glTF
/// culls from view (the inside of a volume is seen), or on one that is not to be seen.
[[nodiscard]] inline bool culled_from_view(const Surface& s) {
    return (!s.front && !s.material->double_sided && !s.material->has_volume) || s.material->unseen;
}
/// COLOR_0 at the hit as linear RGBA; 1 where the mesh has none.
[[nodiscard]] f4 vertex_colour(const Surface&);
/// Material at the hit, textures read: parameters of the Bsdf, and emission.
struct ShadingInput {
    BsdfInput bsdf;
    CoatInput coat;
    Rgb unlit{0.f};    ///< KHR_materials_unlit: shown as it is, nits
    Rgb emitted{0.f};  ///< as core/light/light_sampling.h says, towards the viewer, nits
    Frame frame;       ///< shading frame on wo's side, the normal map applied
    V3f up{0, 0, 1};   ///< Surface::side in the frame

    /// Scattering of light that leaves along `wo`, in world space; throughput as Bsdf has it.
    [[nodiscard]] CoatedBsdf scatter(const V3f& wo, const Bands& bands,
                                     f4 throughput = splat(1.f)) const {
        return {bsdf, coat, bands, frame.to_local(wo), throughput, up};
    }
};
/// Locations of the textures that nearly every material has. Locating them prefetches them, so that
/// time until they are read is not lost.
struct MaterialLookups {
    TextureLookup base_color, metallic_roughness, normal, emissive;
    bool emits;  ///< the side that is seen emits
};
/// Materials that fill space on the two sides of a face; null for air.
struct Fillings {
    const Material* before;  ///< where the ray came from
    const Material* behind;

    /// Those of a volume in air, or of a surface without a volume.
    [[nodiscard]] static Fillings in_air(const Surface& s) {
        return s.front ? Fillings{nullptr, s.material} : Fillings{s.material, nullptr};
    }
};
[[nodiscard]] MaterialLookups locate_material(const Scene&, const Surface&);
[[nodiscard]] ShadingInput read_material(const Scene&, const Surface&, const MaterialLookups&,
                                         const V3f& wo, const Bands&, const Fillings&);
[[nodiscard]] inline ShadingInput read_material(const Scene& scene, const Surface& s, const V3f& wo,
                                                const Bands& bands) {
    return read_material(scene, s, locate_material(scene, s), wo, bands, Fillings::in_air(s));
}

/// Transmittance of a way through a volume: Beer and Lambert's law, with the coefficient that
/// KHR_materials_volume defines, -ln(attenuationColor) / attenuationDistance.
[[nodiscard]] f4 transmittance(const Material&, float distance_m, const Bands&);

}  // namespace petzval
