// SPDX-License-Identifier: Apache-2.0
// Files of others: real scenes must be accepted; of the odd and broken ones those that the Khronos
// validator finds free of errors, and of the rest only those whose errors do not concern Petzval.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "io/base/error.h"
#include "io/gltf/validate/source.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path open_scenes = fs::path(PETZVAL_SHARED) / "scenes/open";

/// Empty when the file is accepted. Only an InputError counts as a refusal.
std::string refusal_of(const fs::path& path) {
    try {
        (void)read_gltf_source(path);
        return {};
    } catch (const InputError& error) {
        return error.what();
    }
}

json read_json(const fs::path& path) {
    std::ifstream in(path);
    return json::parse(in);
}

/// Free of errors, but in need of what Petzval lacks.
const std::set<std::string> beyond_petzval = {
    "validator/asset/min_version_valid.gltf"};  // it wants glTF 2.1

/// Errors that are no reason to refuse a file: docs/design/refusals.md.
const std::set<std::string> tolerated = {
    // What nothing depends on: bounds come from the data, directions are scaled, alignment is for
    // graphics cards, animations are not played.
    "ACCESSOR_MIN_MISMATCH", "ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
    "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
    "ARRAY_LENGTH_NOT_IN_LIST", "ACCESSOR_VECTOR3_NON_UNIT", "ACCESSOR_INVALID_SIGN",
    "EMPTY_ENTITY", "BUFFER_VIEW_TARGET_OVERRIDE", "ANIMATION_DUPLICATE_TARGETS",
    "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE",
    "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
    "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT", "ACCESSOR_ANIMATION_INPUT_NEGATIVE",
    "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
    "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", "ACCESSOR_INVALID_IBM",
    "MESH_PRIMITIVE_ACCESSOR_UNALIGNED", "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
    "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", "BUFFER_VIEW_INVALID_BYTE_STRIDE",
    // Put right, or left out, with a warning.
    "ACCESSOR_NORMALIZED_INVALID", "ACCESSOR_INVALID_FLOAT", "BUFFER_DATA_URI_MIME_TYPE_INVALID",
    "CAMERA_ZFAR_LEQUAL_ZNEAR", "IMAGE_NON_ENABLED_MIME_TYPE", "IMAGE_MIME_TYPE_INVALID",
    "TEXTURE_INVALID_IMAGE_MIME_TYPE", "UNDECLARED_EXTENSION", "UNEXPECTED_EXTENSION_OBJECT",
    "UNUSED_EXTENSION_REQUIRED", "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
    "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
    "MESH_INVALID_WEIGHTS_COUNT", "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
    "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", "ACCESSOR_WEIGHTS_NEGATIVE",
    "ACCESSOR_WEIGHTS_NON_NORMALIZED", "ACCESSOR_JOINTS_INDEX_DUPLICATE", "ROTATION_NON_UNIT",
    "SCENE_NON_ROOT_NODE"};

/// Files whose fault nothing shown depends on, or that has one plain meaning: animations, objects
/// that nothing refers to, absent lengths and types.
const std::set<std::string> kindly_read = {
    "assimp/badNumber/badNumber.gltf",  // in a texture slot without a texture
    "assimp/badString/badString.gltf",  // a name
    "tinygltf/invalid-buffer-index/invalid-buffer-index.gltf",
    "validator/accessor/small_stride.gltf",
    "validator/animation/empty_objects.gltf",
    "validator/animation/unresolved_channel_target.gltf",
    "validator/animation/unresolved_sampler_input.gltf",
    "validator/animation/unresolved_sampler_output.gltf",
    "validator/buffer/invalid_uri_data_bytelength.gltf",
    "validator/buffer/wrong_bytelength.glb",
    "validator/buffer/zero_bytelength.gltf",
    "validator/buffer_view/unresolved_buffer.gltf",
    "validator/buffer_view/zero_bytelength.gltf",
    "validator/camera/empty_objects.gltf",
    "validator/ext/KHR_lights_punctual/light/empty_light_object.gltf",
    "validator/ext/KHR_lights_punctual/light/spot_light_without_spot_object.gltf",
    "validator/ext/KHR_materials_dispersion/material/out_of_range.gltf",
    "validator/ext/KHR_materials_variants/primitive/dependency.gltf",
    "validator/ext/KHR_materials_variants/primitive/empties.gltf",
    "validator/ext/KHR_materials_variants/variant/empty_object.gltf",
    "validator/ext/KHR_materials_variants/variant/invalid_name.gltf",
    "validator/glb/bom.glb",
    "validator/glb/json_and_two_buffers.glb",
    "validator/image/invalid_data_uri.gltf",
    "validator/image/unresolved_buffer_view.gltf",
    "validator/mesh/accessor_attribute_uint32.gltf",
    "validator/node/unresolved_skin.gltf",
    "validator/node/weights_with_no_mesh.gltf",
    "validator/root/invalid_collection_type.gltf"};

/// Files whose only fault lies inside an extension that is not supported and not read.
const std::set<std::string> fault_in_ignored_extension = {
    "KHR_animation_pointer/animation/channel/target/invalid_channel_target_node.gltf",
    "KHR_animation_pointer/animation/channel/target/invalid_channel_target_path.gltf",
    "KHR_animation_pointer/animation/channel/target/invalid_pointer_syntax.gltf",
    "KHR_materials_anisotropy/material/no_tangent_space.gltf"};

/// Empty joints are refused although EMPTY_ENTITY is tolerated: a skin without joints is none.
const std::string empty_joints = "validator/skin/empty_joints_array.gltf";

bool must_be_refused(const std::string& file, const json& codes) {
    if (beyond_petzval.contains(file) || file == empty_joints) return true;
    if (kindly_read.contains(file)) return false;
    const std::string prefix = "validator/ext/";
    if (file.starts_with(prefix) && fault_in_ignored_extension.contains(file.substr(prefix.size())))
        return false;
    for (const std::string code : codes)
        if (code.starts_with("E:") && !tolerated.contains(code.substr(2))) return true;
    return false;
}

TEST(GltfCorpus, OddFilesAreAcceptedAndWrongOnesRefused) {
    if (!fs::exists(open_scenes)) GTEST_SKIP() << open_scenes << " is not there";
    size_t refused = 0, accepted = 0;
    for (const json& entry : read_json(open_scenes / "bad/manifest.json")) {
        const std::string file = entry["file"];
        if (file.starts_with("hdr/")) continue;
        const std::string error = refusal_of(open_scenes / "bad" / file);
        ++(error.empty() ? accepted : refused);
        const json& codes = entry["validator_2_0_dev_3_10"]["codes"];
        EXPECT_EQ(!error.empty(), must_be_refused(file, codes)) << file << codes << '\n' << error;
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    EXPECT_GE(refused, 45u);
    EXPECT_GE(accepted, 140u);
}

TEST(GltfCorpus, RealScenesAreAccepted) {
    if (!fs::exists(open_scenes)) GTEST_SKIP() << open_scenes << " is not there";
    size_t count = 0;
    for (const auto& folder : fs::directory_iterator(open_scenes)) {
        if (!folder.is_directory() || folder.path().filename() == "asset-generator") continue;
        for (const auto& file : fs::directory_iterator(folder)) {
            const auto extension = file.path().extension();
            if (extension != ".glb" && extension != ".gltf") continue;
            EXPECT_EQ(refusal_of(file), "");
            ++count;
        }
    }
    EXPECT_GE(count, 19u);
}

TEST(GltfCorpus, FeatureFilesAreAcceptedUnlessMeantNotToBe) {
    const fs::path root = open_scenes / "asset-generator";
    if (!fs::exists(root)) GTEST_SKIP() << root << " is not there";
    for (const json& category : read_json(root / "manifest.json"))
        for (const json& model : category["models"]) {
            const fs::path path =
                root / std::string(category["folder"]) / std::string(model["fileName"]);
            EXPECT_EQ(refusal_of(path).empty(), model["loadable"].get<bool>()) << path;
        }
}

}  // namespace
}  // namespace petzval::io
