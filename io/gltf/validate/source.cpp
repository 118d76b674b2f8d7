// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/source.h"

#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/file/read_file.h"
#include "io/gltf/animation/pose.h"
#include "io/gltf/mend/mend.h"
#include "io/gltf/validate/budget.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/files.h"
#include "io/gltf/validate/foreign.h"
#include "io/gltf/validate/glb.h"

namespace petzval::io {
namespace {

/// Checks everything that consists of references and numbers only.
void check_scene_graph(GltfCheck& check) {
    check_textures(check);
    check_materials(check);
    check_meshes(check);
    check_variants(check);
    check_cameras(check);
    check_lights(check);
    check_image_lights(check);
    check_skins(check);
    check_nodes(check);
}

/// A file as it lies on the disk. `chunks` views `file`.
struct Opened {
    FileBytes file;
    bool binary = false;
    GlbChunks chunks;
};

/// Reads the file, and its JSON into `source`, mended.
Opened open_gltf(const std::filesystem::path& path, GltfSource& source) {
    const std::string name = path.string();
    const std::string foreign = foreign_scene_advice(path);
    if (!foreign.empty()) throw InputError(name, "", foreign);
    Opened out{read_file(path), false, {}};
    if (!out.file.error.empty()) throw InputError(name, "", out.file.error);
    const auto& bytes = out.file.bytes;
    out.binary = is_glb(bytes);
    out.chunks = {{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}};
    const size_t begin = out.chunks.json.find_first_not_of("\xEF\xBB\xBF \t\r\n");
    if (out.binary)
        out.chunks = split_glb(bytes, name, source.warnings);
    else if (begin == std::string_view::npos || out.chunks.json[begin] != '{')
        throw InputError(name, "",
                         "is {}no glTF: a .glb begins with the letters glTF, a .gltf with {{; "
                         "export the scene again",
                         is_text(out.chunks.json) ? "a text file, and " : "");
    source.path = path;
    source.json = parse_json(out.chunks.json, name);
    mend_gltf(source.json, source.warnings);
    return out;
}

}  // namespace

std::vector<ExtensionInFile> read_gltf_extensions(const std::filesystem::path& path) {
    GltfSource source;
    (void)open_gltf(path, source);
    GltfBudget budget;
    const std::string name = path.string();
    GltfCheck check{source, JsonCursor(source.json, name), budget};
    check_asset(check);
    list_extensions(check);
    return source.extensions;
}

GltfSource read_gltf_source(const std::filesystem::path& path, FileScope scope,
                            const std::optional<AnimationChoice>& animation,
                            bool checks_all_animations) {
    GltfSource source;
    const Opened opened = open_gltf(path, source);
    source.files.push_back(path);
    source.scope = scope;
    source.hash = fnv1a(opened.file.bytes);
    GltfBudget budget;
    budget.add_owned(opened.file.bytes.size());

    const std::string name = path.string();
    GltfCheck check{source, JsonCursor(source.json, name), budget};
    check_asset(check);
    list_extensions(check);
    check_extensions(check);
    check_collections(check);
    check.reads_all_animations = checks_all_animations;
    if (animation) check.played = played_animations(source.json, *animation, name);
    check.use = find_used(source.json, check.played);
    read_buffers(source, {opened.binary, opened.chunks.bin}, budget);
    decode_buffer_views(check);
    check_buffer_views(check);
    decode_primitives(check);
    check_accessors(check);
    read_images(source, check.use, budget);
    read_light_profiles(source, budget);
    check_scene_graph(check);
    check_animations(check);
    check_data(check);
    return source;
}

void pose_source(GltfSource& source, const AnimationChoice& choice) {
    pose(source.json, source.clips, choice.time_s, choice.time_s, choice.repeats);
    WarningLog said;  // of the file, not of a moment
    std::swap(said, source.warnings);
    mend_gltf(source.json, source.warnings);
    const std::string name = source.path.string();
    GltfBudget budget;
    for (const auto& buffer : source.buffers) budget.add_owned(buffer.size());
    GltfCheck check{source, JsonCursor(source.json, name), budget};
    check.use = find_used(source.json, {});
    check_accessors(check);
    check_scene_graph(check);
    std::swap(said, source.warnings);
}

}  // namespace petzval::io
