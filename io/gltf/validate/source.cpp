// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/source.h"

#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/base/read_file.h"
#include "io/gltf/mend/mend.h"
#include "io/gltf/validate/budget.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/files.h"
#include "io/gltf/validate/foreign.h"
#include "io/gltf/validate/glb.h"

namespace petzval {
namespace {

/// Checks everything that consists of references and numbers only.
void check_scene_graph(GltfCheck& check) {
    check_textures(check);
    check_materials(check);
    check_meshes(check);
    check_variants(check);
    check_cameras(check);
    check_lights(check);
    check_skins(check);
    check_nodes(check);
    check_animations(check);
}

}  // namespace

GltfSource read_gltf_source(const std::filesystem::path& path, FileScope scope) {
    const std::string name = path.string();
    const std::string foreign = foreign_scene_advice(path);
    if (!foreign.empty()) throw InputError(name, "", foreign);
    const FileBytes file = read_file(path);
    if (!file.error.empty()) throw InputError(name, "", file.error);

    GltfSource source;
    source.path = path;
    source.files.push_back(path);
    source.scope = scope;
    source.hash = fnv1a(file.bytes);
    GltfBudget budget;
    budget.add_owned(file.bytes.size());

    const bool binary = is_glb(file.bytes);
    GlbChunks chunks{{reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()}, {}};
    if (binary) chunks = split_glb(file.bytes, name, source.warnings);
    source.json = parse_json(chunks.json, name);

    mend_gltf(source.json, source.warnings);

    GltfCheck check{source, JsonCursor(source.json, name), budget, {}, find_used(source.json)};
    check_asset(check);
    check_extensions(check);
    check_collections(check);
    read_buffers(source, {binary, chunks.bin}, budget);
    decode_buffer_views(check);
    check_buffer_views(check);
    decode_primitives(check);
    check_accessors(check);
    read_images(source, check.use, budget);
    check_scene_graph(check);
    check_data(check);
    return source;
}

}  // namespace petzval
