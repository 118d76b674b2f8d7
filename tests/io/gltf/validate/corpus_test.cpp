// SPDX-License-Identifier: Apache-2.0
// Files of others: real scenes must be accepted; of the odd and broken ones those that the Khronos
// validator finds free of errors, and of the rest only those whose errors do not concern Petzval.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "io/base/error.h"
#include "io/gltf/validate/source.h"

namespace petzval {
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
    "unsupported/BoxDraco/BoxDraco.gltf", "unsupported/BoxMeshopt/BoxMeshopt.glb",
    "validator/asset/min_version_valid.gltf"};  // it wants glTF 2.1

/// Errors that are no reason to refuse a file.
const std::set<std::string> tolerated = {
    // min and max are not used: bounds come from the data.
    "ACCESSOR_MIN_MISMATCH", "ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
    "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
    // Normals and tangents give directions; whoever reads them scales them.
    "ACCESSOR_VECTOR3_NON_UNIT", "ACCESSOR_INVALID_SIGN",
    // An empty array asks for nothing, and exporters write them.
    "EMPTY_ENTITY",
    // A hint for graphics cards.
    "BUFFER_VIEW_TARGET_OVERRIDE",
    // Animations are not played, skins not deformed; what they refer to is checked all the same.
    "ANIMATION_DUPLICATE_TARGETS", "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS",
    "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE", "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
    "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT", "ACCESSOR_ANIMATION_INPUT_NEGATIVE",
    "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
    "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", "ACCESSOR_INVALID_IBM"};

/// Files whose only fault lies inside an extension that is not supported and not read.
const std::set<std::string> fault_in_ignored_extension = {
    "KHR_animation_pointer/animation/channel/target/invalid_channel_target_node.gltf",
    "KHR_animation_pointer/animation/channel/target/invalid_channel_target_path.gltf",
    "KHR_animation_pointer/animation/channel/target/invalid_pointer_syntax.gltf",
    "KHR_materials_anisotropy/material/no_tangent_space.gltf",
    "KHR_materials_variants/primitive/dependency.gltf",
    "KHR_materials_variants/primitive/empties.gltf",
    "KHR_materials_variants/variant/empty_object.gltf",
    "KHR_materials_variants/variant/invalid_name.gltf"};

/// Empty joints are refused although EMPTY_ENTITY is tolerated: a skin without joints is none.
const std::string empty_joints = "validator/skin/empty_joints_array.gltf";

bool must_be_refused(const std::string& file, const json& codes) {
    if (beyond_petzval.contains(file) || file == empty_joints) return true;
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
    EXPECT_GE(refused, 100u);
    EXPECT_GE(accepted, 70u);
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
}  // namespace petzval
