// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_sampling.h"

#include <algorithm>

#include "core/light/spherical_triangle.h"
#include "core/light/sun_disc.h"
#include "core/sampling/warp.h"
#include "core/scene/coverage.h"
#include "core/scene/motion.h"
#include "core/scene/scene.h"

namespace petzval {
namespace {

// Longest edge of a triangle over the distance of its middle, squared, from which on it is drawn by
// solid angle. From 1/4 on, the error is no smaller, and rooms take 5 to 8 % more time.
constexpr float kWideRatio = 1.f;
constexpr float kLeastSolidAngle = 1e-4f;  // sr

template <class L>
std::optional<LightSample> sample_at(const Scene& scene, const L& light, Rgb intensity_cd,
                                     const V3f& p, const Bands& bands) {
    const V3f to_light = light.position - p;
    const float distance2 = to_light.dot(to_light);
    if (!(distance2 > 0.f)) return std::nullopt;
    return LightSample{
        to_light / std::sqrt(distance2),
        light.position,
        false,
        scene.uplift_radiance(intensity_cd * (1.f / distance2), bands, light.illuminant),
        1.f,
        true};
}

std::optional<LightSample> sample(const Scene& scene, const PointLight& light, const V3f& p, V2f,
                                  const Bands& bands, float) {
    return sample_at(scene, light, light.intensity_cd, p, bands);
}

std::optional<LightSample> sample(const Scene& scene, const SpotLight& light, const V3f& p, V2f,
                                  const Bands& bands, float) {
    auto drawn = sample_at(scene, light, light.intensity_cd, p, bands);
    if (!drawn) return drawn;
    const float falloff = light.beam().falloff(-drawn->direction.dot(light.direction));
    if (falloff == 0.f) return std::nullopt;
    drawn->radiance *= falloff;
    return drawn;
}

std::optional<LightSample> sample(const Scene& scene, const ProfileLight& light, const V3f& p, V2f,
                                  const Bands& bands, float) {
    const V3f away = p - light.position;
    const float distance = away.length();
    if (!(distance > 0.f)) return std::nullopt;
    const V3f local(away.dot(light.x), away.dot(light.y), away.dot(light.f));
    const float candela = scene.profiles[light.profile].intensity(local / distance);
    if (!(candela > 0.f)) return std::nullopt;
    return sample_at(scene, light, light.factor * candela, p, bands);
}

std::optional<LightSample> sample(const Scene& scene, const SunLight& light, const V3f&, V2f u,
                                  const Bands& bands, float) {
    if (light.has_disc())
        return LightSample{direction_in_disc(light, u),
                           V3f(0.f),
                           true,
                           scene.uplift_radiance(disc_radiance(light), bands, light.illuminant),
                           disc_pdf(light),
                           false};
    const f4 irradiance = scene.uplift_radiance(light.illuminance_lx, bands, light.illuminant);
    return LightSample{-light.direction, {}, true, irradiance, 1.f, true};
}

// Bound on how far rounding moves a point of a triangle off its plane: by the roundings of its own
// coordinates (interpolation, placement), and of the ray's, which grow with the distance.
V3f plane_error(const Scene& scene, const TriangleLight& light, const V3f& target,
                const V3f& to_light, const std::array<V3f, 3>& corner) {
    const V3f corners = abs(corner[0]) + abs(corner[1]) + abs(corner[2]) + abs(target);
    V3f error = (corners + abs(to_light)) * rounding_bound(8);
    const Instance& instance = scene.instances[light.instance];
    if (!instance.moves) [[likely]] {
        if (instance.identity) return error;
        const M44f& m = instance.to_world;
        return error + abs(V3f(m[3][0], m[3][1], m[3][2])) * rounding_bound(8);
    }
    // Between steps a point may be near 0, and its roundings are those of the steps.
    return error + (abs(scene.bounds.min) + abs(scene.bounds.max)) * rounding_bound(16);
}

// The triangle as p sees it, where its directions are drawn by solid angle: where it is wide, as
// points that are uniform by area are then far from uniform. Not where p is as near to its plane as
// rounding: a point of the lamp itself would be lit by it.
[[gnu::always_inline]] inline std::optional<SphericalTriangle> if_wide(
    const Scene& scene, const TriangleLight& light, const V3f& p,
    const std::array<V3f, 3>& corner) {
    const V3f middle = (corner[0] + corner[1] + corner[2]) / 3.f, to_middle = middle - p;
    float edge2 = 0.f;
    for (size_t i = 0; i < 3; ++i) {
        const V3f edge = corner[(i + 1) % 3] - corner[i];
        edge2 = std::max(edge2, edge.dot(edge));
    }
    if (!(edge2 > kWideRatio * to_middle.dot(to_middle))) return std::nullopt;
    const V3f normal = unit((corner[1] - corner[0]).cross(corner[2] - corner[0]));
    const V3f error = plane_error(scene, light, middle, to_middle, corner);
    if (!(std::fabs(normal.dot(to_middle)) > 8.f * error.dot(abs(normal)))) return std::nullopt;
    const SphericalTriangle seen(p, corner);
    if (!(seen.solid_angle() > kLeastSolidAngle)) return std::nullopt;
    return seen;
}

// Weights of the second and third corner of the point where a direction from p meets the triangle;
// what rounding puts beyond its edges is brought back. In double precision, as squares of an area
// may leave the range of floats.
V2f where_met(const V3f& p, const V3f& direction, const std::array<V3f, 3>& corner) {
    const V3d edge1 = V3d(corner[1]) - V3d(corner[0]), edge2 = V3d(corner[2]) - V3d(corner[0]);
    const V3d cross = edge1.cross(edge2), from = V3d(p) - V3d(corner[0]), along(direction);
    const V3d at = from - along * (from.dot(cross) / along.dot(cross));
    const double scale = 1. / cross.dot(cross);
    const double b = std::clamp(at.cross(edge2).dot(cross) * scale, 0., 1.);
    const double c = std::clamp(edge1.cross(at).dot(cross) * scale, 0., 1. - b);
    return {static_cast<float>(b), static_cast<float>(c)};
}

std::optional<LightSample> sample(const Scene& scene, const TriangleLight& light, const V3f& p,
                                  V2f u, const Bands& bands, float time) {
    const auto corner = triangle_corners(scene, light.instance, light.triangle, time);
    const V3f edge1 = corner[1] - corner[0], edge2 = corner[2] - corner[0];
    const V3f cross = edge1.cross(edge2);  // twice the area long
    const auto wide = if_wide(scene, light, p, corner);
    const V3f drawn = wide ? wide->direction(u) : V3f(0.f);
    const V2f b = wide ? where_met(p, drawn, corner) : uniform_triangle(u);
    const V3f target = corner[0] + edge1 * b.x + edge2 * b.y;
    const V3f to_light = target - p;
    const float distance2 = to_light.dot(to_light), facing = -cross.dot(to_light);
    const float distance = std::sqrt(distance2);
    const float by_area = 2.f * distance2 * distance / std::fabs(facing);
    if (!(by_area > 0.f && by_area < kInfinity)) return std::nullopt;

    const bool front = (facing > 0.f) != flips_at(scene, light.instance, time);
    Rgb emitted = emitted_radiance(scene, light.instance, light.triangle, b, front);
    const Material& material =
        scene.materials[scene.meshes[scene.instances[light.instance].mesh].material];
    if (material.cutout()) emitted = emitted * coverage(scene, light.instance, light.triangle, b);
    if (material.beam)
        emitted =
            emitted * material.beam->falloff(
                          (wide ? -drawn : to_light / -distance).dot(material.beam->direction));
    if (material.coat > 0.f)
        emitted = emitted * share_past_coat(scene, light.instance, light.triangle, b,
                                            std::fabs(facing) / (cross.length() * distance));
    if (!(hmax(emitted.v) > 0.f)) return std::nullopt;
    const V3f error = plane_error(scene, light, target, to_light, corner);
    // Near a large lamp the rounded target lies aside of the direction that was drawn.
    return LightSample{wide ? drawn : to_light / distance,
                       offset_origin(target, error, unit(cross), -to_light),
                       false,
                       scene.uplift_radiance(emitted, bands, material.illuminant),
                       wide ? 1.f / wide->solid_angle() : by_area,
                       false};
}

std::optional<LightSample> sample(const Scene& scene, const SkyLight&, const V3f&, V2f u,
                                  const Bands& bands, float) {
    if (scene.sky.even()) return std::nullopt;
    const Sky::Draw drawn = scene.sky.sample(u);
    const Sky::Found found = scene.sky.find(drawn.place);
    if (!(found.pdf > 0.f)) return std::nullopt;  // drawn at the very rim of a texel's tent
    return LightSample{drawn.direction, {},   true, uplift_radiance(found.radiance, bands),
                       found.pdf,       false};
}

}  // namespace

Rgb emitted_radiance(const Scene& scene, uint32_t instance, uint32_t triangle, V2f barycentric,
                     bool front) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    if (!(front || material.double_sided) || !material.emits() || material.unlit) return Rgb(0.f);
    const TextureSlot& slot = material.emissive_texture;
    if (!slot.present()) return material.emissive;
    const V2f uv = mesh.uv_at(triangle, barycentric, slot.uv_set);
    f4 texel = sample_texture(scene.images, slot, uv);
    texel[3] = 0.f;
    return material.emissive * Rgb(texel);
}

float share_past_coat(const Scene& scene, uint32_t instance, uint32_t triangle, V2f barycentric,
                      float cosine) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    const TextureSlot& slot = material.coat_texture;
    float weight = material.coat;
    if (slot.present()) {
        const V2f uv = mesh.uv_at(triangle, barycentric, slot.uv_set);
        weight *= sample_texture(scene.images, slot, uv)[0];
    }
    return past_coat(weight, cosine);
}

std::optional<LightSample> sample_light(const Scene& scene, const Light& light, const V3f& p, V2f u,
                                        const Bands& bands, float time) {
    return std::visit([&](const auto& kind) { return sample(scene, kind, p, u, bands, time); },
                      light);
}

float triangle_light_pdf(const Scene& scene, const TriangleLight& light, const V3f& p,
                         float distance_squared, float cosine, float time) {
    const auto corner = triangle_corners(scene, light.instance, light.triangle, time);
    if (const auto wide = if_wide(scene, light, p, corner)) return 1.f / wide->solid_angle();
    return distance_squared / (std::fabs(cosine) * triangle_area(corner));
}

}  // namespace petzval
