// SPDX-License-Identifier: Apache-2.0
#include "core/scene/coverage.h"

#include "core/scene/scene.h"

namespace petzval {

float coverage(const Scene& scene, uint32_t instance, uint32_t triangle, V2f barycentric) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material = scene.materials[mesh.material];
    if (!material.cutout()) return 1.f;
    float alpha = material.alpha;
    const TextureSlot& slot = material.base_color_texture;
    if (slot.present()) {
        const V2f uv = mesh.uv_at(triangle, barycentric, slot.uv_set);
        alpha *= sample_texture(scene.images, slot, uv)[3];
    }
    if (!mesh.colours.empty()) alpha *= mesh.alpha_at(instance, triangle, barycentric);
    if (material.alpha_mode == AlphaMode::Mask) return alpha >= material.alpha_cutoff ? 1.f : 0.f;
    return clamp_unit(alpha);
}

}  // namespace petzval
