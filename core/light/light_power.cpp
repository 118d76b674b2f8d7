// SPDX-License-Identifier: Apache-2.0
// Power of each kind of light, by which lights are chosen.
#include <algorithm>

#include "core/light/light_sampling.h"
#include "core/sampling/warp.h"
#include "core/scene/coverage.h"
#include "core/scene/motion.h"
#include "core/scene/scene.h"

namespace petzval {
namespace {

// Greatest area while the shutter is open: a light that has none at a moment must be picked at
// others.
float greatest_area(const Scene& scene, const TriangleLight& light) {
    const size_t steps = step_count(scene, light.instance);
    float most = 0.f;
    for (size_t i = 0; i < steps; ++i)
        most = std::max(most, triangle_area(triangle_corners(scene, light.instance, light.triangle,
                                                             step_time(i, steps))));
    return most;
}

// Area of the scene's silhouette from afar, bounded by its sphere; that of a unit sphere where the
// scene has no extent, so that its lights keep their proportions.
float silhouette_m2(const Scene& scene) {
    const float radius2 = scene.bounds.isEmpty() ? 0.f : 0.25f * scene.bounds.size().length2();
    return kPi * (radius2 > 0.f ? radius2 : 1.f);
}

// Mean luminance over 16 points, one in each of 16 equal parts of the triangle. Texels may shine
// between the points: what they miss keeps a thousandth of the untextured value.
float mean_emission(const Scene& scene, const TriangleLight& light) {
    const Mesh& mesh = scene.meshes[scene.instances[light.instance].mesh];
    const Material& material = scene.materials[mesh.material];
    const float untextured = luminance(material.emissive);
    if (!material.emissive_texture.present() && !material.cutout()) return untextured;
    float sum = 0.f;
    for (int i = 0; i < 16; ++i) {
        const V2f u((i / 4 + 0.5f) / 4, (i % 4 + 0.5f) / 4);
        const V2f b = uniform_triangle(u);
        sum += luminance(emitted_radiance(scene, light.instance, light.triangle, b, true)) *
               coverage(scene, light.instance, light.triangle, b);
    }
    return std::max(sum / 16, 1e-3f * untextured);
}

// Integral over a beam of the cosine to a triangle's front, or to both of its sides; at least a
// thousandth of the whole beam where some of it leaves the triangle.
float projected_beam(const Beam& beam, const Scene& scene, const TriangleLight& light,
                     bool double_sided) {
    constexpr int rings = 16, sectors = 16;
    const auto corner = triangle_corners(scene, light.instance, light.triangle);
    const V3f cross = unit((corner[1] - corner[0]).cross(corner[2] - corner[0]));
    const Frame frame = Frame::about(beam.direction);
    const V3f front =
        frame.to_local(flips_at(scene, light.instance, kMiddleOfShutter) ? -cross : cross);
    float whole = 0.f, sum = 0.f;
    for (int i = 0; i < rings; ++i) {
        const float cosine = lerp(1.f, beam.cos_outer, (i + 0.5f) / rings);
        const float sine = safe_sqrt(1.f - sqr(cosine)), falloff = beam.falloff(cosine);
        for (int k = 0; k < sectors; ++k) {
            const float phi = 2 * kPi * (k + 0.5f) / sectors;
            const float facing = front.dot(V3f(sine * std::cos(phi), sine * std::sin(phi), cosine));
            whole += falloff;
            sum += falloff * (double_sided ? std::fabs(facing) : std::max(facing, 0.f));
        }
    }
    constexpr float slack = 1e-3f;
    const bool some = double_sided || front.z > -safe_sqrt(1.f - sqr(beam.cos_outer)) - slack;
    const float solid_angle = 2 * kPi * (1.f - beam.cos_outer) / (rings * sectors);
    return some ? std::max(sum, 1e-3f * whole) * solid_angle : 0.f;
}

float power(const Scene&, const PointLight& light) {
    return 4 * kPi * luminance(light.intensity_cd);
}

// Power of a spot: the integral of its falloff over the sphere. The narrowest cones saturate beyond
// the axis.
float power(const Scene&, const SpotLight& light) {
    const float width = light.beam().width(), reach = 1.f - light.cos_outer;
    const float ramp = std::min(reach, width);
    const float integral = ramp * sqr(ramp / width) / 3 + (reach - ramp);
    return 2 * kPi * integral * luminance(light.intensity_cd);
}

float power(const Scene& scene, const ProfileLight& light) {
    return luminance(light.factor) * scene.profiles[light.profile].flux_lm();
}

float power(const Scene& scene, const SunLight& light) {
    return luminance(light.illuminance_lx) * silhouette_m2(scene);
}

float power(const Scene& scene, const TriangleLight& light) {
    const Mesh& mesh = scene.meshes[scene.instances[light.instance].mesh];
    const float area = greatest_area(scene, light);
    if (!(area > 0.f)) return 0.f;
    const Material& material = scene.materials[mesh.material];
    if (material.beam)
        return projected_beam(*material.beam, scene, light, material.double_sided) * area *
               mean_emission(scene, light);
    const float sides = material.double_sided ? 2.f : 1.f;
    return sides * kPi * area * mean_emission(scene, light);
}

float power(const Scene& scene, const SkyLight&) {
    return 4 * kPi * scene.sky.drawn_luminance() * silhouette_m2(scene);
}

}  // namespace

float light_power(const Scene& scene, const Light& light) {
    return std::visit([&](const auto& kind) { return power(scene, kind); }, light);
}

}  // namespace petzval
