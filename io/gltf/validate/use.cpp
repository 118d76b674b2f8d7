// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/use.h"

#include "io/base/json_parse.h"

namespace petzval::io {
namespace {

using nlohmann::json;

template <class Visit>
void each(const json& owner, const char* key, Visit visit) {
    if (const json& items = member(owner, key); items.is_array())
        for (const json& item : items) visit(item);
}

size_t count(const json& root, const char* kind) {
    const json& items = member(root, kind);
    return items.is_array() ? items.size() : 0;
}

void mark(std::vector<bool>& used, const json& index) {
    if (!index.is_number_integer() || index.get<double>() < 0) return;
    if (const auto at = index.get<uint64_t>(); at < used.size()) used[at] = true;
}

void mark_all(std::vector<bool>& used, const json& attributes) {
    if (attributes.is_object())
        for (const json& index : attributes) mark(used, index);
}

void mark_images(const json& root, GltfUse& use) {
    each(root, "textures", [&](const json& texture) {
        mark(use.images, member(texture, "source"));
        if (const json& extensions = member(texture, "extensions"); extensions.is_object())
            for (const json& extension : extensions) mark(use.images, member(extension, "source"));
    });
}

/// Images of the first level of each cube: the others are blurred copies of it.
void mark_cubes(const json& root, GltfUse& use) {
    each(member(member(root, "extensions"), "EXT_lights_image_based"), "lights",
         [&](const json& light) {
             const json& levels = member(light, "specularImages");
             if (levels.is_array() && !levels.empty() && levels[0].is_array())
                 for (const json& image : levels[0]) mark(use.images, image);
         });
}

void mark_accessors(const json& root, GltfUse& use) {
    each(root, "meshes", [&](const json& mesh) {
        each(mesh, "primitives", [&](const json& primitive) {
            mark(use.accessors, member(primitive, "indices"));
            mark_all(use.accessors, member(primitive, "attributes"));
            each(primitive, "targets",
                 [&](const json& target) { mark_all(use.accessors, target); });
        });
    });
    each(root, "nodes", [&](const json& node) {
        const json& attributes =
            member(member(member(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes");
        for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
            mark(use.accessors, member(attributes, name));
    });
    each(root, "skins",
         [&](const json& skin) { mark(use.accessors, member(skin, "inverseBindMatrices")); });
}

void mark_played(const json& root, std::span<const size_t> played, GltfUse& use) {
    for (const size_t i : played)
        each(member(root, "animations")[i], "samplers", [&](const json& sampler) {
            mark(use.accessors, member(sampler, "input"));
            mark(use.accessors, member(sampler, "output"));
        });
}

void mark_views(const json& root, GltfUse& use) {
    const auto of_used = [&](const char* kind, const std::vector<bool>& used, auto mark_views_of) {
        size_t i = 0;
        each(root, kind, [&](const json& object) {
            if (used[i++]) mark_views_of(object);
        });
    };
    of_used("images", use.images,
            [&](const json& image) { mark(use.views, member(image, "bufferView")); });
    each(member(member(root, "extensions"), "EXT_lights_ies"), "lights",
         [&](const json& light) { mark(use.views, member(light, "bufferView")); });
    of_used("accessors", use.accessors, [&](const json& accessor) {
        mark(use.views, member(accessor, "bufferView"));
        for (const char* part : {"indices", "values"})
            mark(use.views, member(member(member(accessor, "sparse"), part), "bufferView"));
    });
    each(root, "meshes", [&](const json& mesh) {
        each(mesh, "primitives", [&](const json& primitive) {
            const json& draco =
                member(member(primitive, "extensions"), "KHR_draco_mesh_compression");
            mark(use.views, member(draco, "bufferView"));
        });
    });
}

}  // namespace

GltfUse find_used(const json& root, std::span<const size_t> played) {
    GltfUse use{std::vector<bool>(count(root, "accessors")),
                std::vector<bool>(count(root, "bufferViews")),
                std::vector<bool>(count(root, "images"))};
    mark_images(root, use);
    mark_cubes(root, use);
    mark_accessors(root, use);
    mark_played(root, played, use);
    mark_views(root, use);
    return use;
}

}  // namespace petzval::io
