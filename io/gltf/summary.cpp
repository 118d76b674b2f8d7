// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/summary.h"

#include <tiny_gltf.h>

#include <algorithm>

#include "io/base/json_cursor.h"
#include "io/base/json_parse.h"
#include "io/gltf/document/variants.h"
#include "io/gltf/info.h"

namespace petzval::io {
namespace {

using nlohmann::json;

constexpr size_t kMostAnimations = 100;

template <class T>
uint64_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

uint64_t bytes_of(const Mesh& mesh) {
    uint64_t bytes = bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.tangents) +
                     bytes_of(mesh.colours) + bytes_of(mesh.triangles);
    for (const auto& uv : mesh.uv) bytes += bytes_of(uv);
    for (const auto& uv : mesh.more_uv) bytes += bytes_of(uv);
    return bytes;
}

// The latest time at which an animation has a key. Animations are not checked: what is wrong in
// one is passed over.
std::optional<double> duration_s(const json& root, const json& animation) {
    std::optional<double> last;
    for (const json& sampler : member(animation, "samplers")) {
        const json& input = member(sampler, "input");
        const json& accessors = member(root, "accessors");
        if (!input.is_number_unsigned() || input.get<uint64_t>() >= accessors.size()) continue;
        const json& most = member(accessors[input.get<uint64_t>()], "max");
        if (most.is_array() && most.size() == 1 && most[0].is_number())
            last = std::max(last.value_or(0), most[0].get<double>());
    }
    return last;
}

GltfSummary::Animation read_animation(const json& root, const json& animation) {
    return {text_of(animation, "name"), member(animation, "channels").size(),
            duration_s(root, animation)};
}

GltfSummary::Lights count_lights(const Scene& scene, const GltfTally& tally) {
    const auto count = [&](size_t kind) {
        return static_cast<uint64_t>(
            std::count_if(scene.lights.begin(), scene.lights.end(),
                          [&](const Light& light) { return light.index() == kind; }));
    };
    GltfSummary::Lights lights{
        .point = count(0) + tally.point_lamps,
        .spot = count(1) + tally.spot_lamps,
        .directional = count(2),
        .balls = tally.point_lamps + tally.spot_lamps,
        .flat = tally.flat_lamps,
        .profiles = count(Light(ProfileLight()).index()),
    };
    for (const Instance& instance : scene.instances) {
        if (!emits(scene, instance)) continue;
        ++lights.emissive_meshes;
        lights.emissive_triangles += scene.meshes[instance.mesh].triangles.size();
    }
    return lights;
}

void count_meshes(const Scene& scene, GltfSummary& out) {
    out.meshes_stored = scene.meshes.size();
    out.meshes_placed = scene.instances.size();
    for (const Mesh& mesh : scene.meshes) {
        out.triangles_stored += mesh.triangles.size();
        out.mesh_bytes += bytes_of(mesh);
    }
    for (const Instance& instance : scene.instances)
        out.triangles_placed += scene.meshes[instance.mesh].triangles.size();
}

}  // namespace

GltfSummary summarise(const GltfModel& gltf, const GltfTally& tally, const Scene& scene) {
    const json& root = gltf.source.json;
    GltfSummary out;
    out.generator = gltf.typed.asset.generator;
    out.extensions = gltf.source.extensions;
    for (const json& one : member(root, "scenes")) out.scenes.push_back(text_of(one, "name"));
    out.variants = variant_names(gltf);
    const json& animations = member(root, "animations");
    out.animation_count = animations.size();
    for (size_t i = 0; i < std::min(animations.size(), kMostAnimations); ++i)
        out.animations.push_back(read_animation(root, animations[i]));
    out.nodes = member(root, "nodes").size();
    out.materials = scene.materials.size();
    count_meshes(scene, out);
    for (const Image& image : scene.images)
        out.pictures.push_back(
            {image.name, image.width, image.height,
             std::visit([](const auto& texels) { return bytes_of(texels); }, image.texels)});
    out.lights = count_lights(scene, tally);
    return out;
}

}  // namespace petzval::io
