// SPDX-License-Identifier: Apache-2.0
#include "core/light/own_light.h"

#include <algorithm>

#include "core/light/light_sampling.h"

namespace petzval {
namespace {

/// The most that a surface emits without KHR_materials_emissive_strength.
constexpr float kBrightestGlow_nits = 1;
/// Mean emission from which a picture is not almost black.
constexpr double kFaint_nits = 0.01;

// Sums over the triangles of an instance.
struct Emitted {
    double area_m2 = 0, times_nits = 0;
};

Emitted emitted_by(const Scene& scene, uint32_t instance) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const bool glows = emits(scene, scene.instances[instance]);
    const double sides = scene.materials[mesh.material].double_sided ? 2 : 1;
    Emitted sum;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto corner = triangle_corners(scene, instance, i);
        sum.area_m2 += double((corner[1] - corner[0]).cross(corner[2] - corner[0]).length()) / 2;
        if (glows)
            sum.times_nits +=
                double(light_power(scene, TriangleLight{instance, i})) / (sides * double(kPi));
    }
    return sum;
}

}  // namespace

OwnLight own_light(const Scene& scene) {
    if (!scene.lights.empty()) return OwnLight::Enough;
    bool glows = false, all_unlit = !scene.instances.empty();
    for (const Instance& instance : scene.instances) {
        const Material& material = scene.materials[scene.meshes[instance.mesh].material];
        all_unlit = all_unlit && material.unlit;
        if (!emits(scene, instance)) continue;
        glows = true;
        const Rgb& nits = material.emissive;
        if (std::max({nits[0], nits[1], nits[2]}) > kBrightestGlow_nits) return OwnLight::Enough;
    }
    if (all_unlit) return OwnLight::Enough;
    if (!glows) return OwnLight::None;
    Emitted all;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Emitted one = emitted_by(scene, i);
        all.area_m2 += one.area_m2;
        all.times_nits += one.times_nits;
    }
    return all.times_nits < kFaint_nits * all.area_m2 ? OwnLight::Faint : OwnLight::Enough;
}

}  // namespace petzval
