// SPDX-License-Identifier: Apache-2.0
#include "core/light/emission.h"

#include "core/scene/scene.h"

namespace petzval {

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

const Illuminant* white_of(const Scene& scene, uint32_t instance) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    return scene.illuminant(scene.materials[mesh.material].illuminant);
}

}  // namespace petzval
