// SPDX-License-Identifier: Apache-2.0
#include "core/emission.h"

#include <algorithm>

#include "core/scene.h"

namespace petzval {
namespace {

V2f uv_at(const Mesh& mesh, uint32_t triangle, V2f barycentric, int uv_set) {
    const auto& uv = mesh.uv[uv_set];
    return uv.empty() ? V2f(0.f) : interpolate(uv, mesh.triangles[triangle], barycentric);
}

}  // namespace

Rgb emitted_radiance(const Scene& scene, uint32_t instance, uint32_t triangle, V2f barycentric,
                     bool front) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    if (!(front || material.double_sided) || !material.emits() || material.unlit) return Rgb(0.f);
    const TextureSlot& slot = material.emissive_texture;
    if (!slot.present()) return material.emissive;
    const V2f uv = uv_at(mesh, triangle, barycentric, slot.uv_set);
    f4 texel = sample_texture(scene.images, slot, uv);
    texel[3] = 0.f;
    return material.emissive * Rgb(texel);
}

const Illuminant* white_of(const Scene& scene, uint32_t instance) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    return scene.illuminant(scene.materials[mesh.material].illuminant);
}

float coverage(const Scene& scene, uint32_t instance, uint32_t triangle, V2f barycentric) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    if (!material.cutout()) return 1.f;
    float alpha = material.alpha;
    const TextureSlot& slot = material.base_color_texture;
    if (slot.present()) {
        const V2f uv = uv_at(mesh, triangle, barycentric, slot.uv_set);
        alpha *= sample_texture(scene.images, slot, uv)[3];
    }
    if (!mesh.colours.empty())
        alpha *= interpolate(mesh.colours, mesh.triangles[triangle], barycentric).w;
    if (material.alpha_mode == AlphaMode::Mask) return alpha >= material.alpha_cutoff ? 1.f : 0.f;
    return std::clamp(alpha, 0.f, 1.f);
}

}  // namespace petzval
