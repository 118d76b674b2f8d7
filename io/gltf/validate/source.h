// SPDX-License-Identifier: Apache-2.0
// A glTF file taken apart and checked: what the loader may rely on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/spectrum/metal.h"
#include "io/base/warning_log.h"
#include "io/gltf/animation/clip.h"
#include "io/gltf/schema/extensions.h"
#include "io/gltf/validate/accessor.h"

namespace petzval::io {

/// Folders in which the files may lie that a scene names. Confined: that of the scene and those
/// below it, all links followed.
enum class FileScope : uint8_t { Anywhere, Confined };

/// JSON that passed every check of check_gltf, with the bytes it refers to.
struct GltfSource {
    std::filesystem::path path;
    FileScope scope = FileScope::Anywhere;
    nlohmann::json json;
    /// Bytes of each buffer, read from its file, its data URI or the binary chunk; at least
    /// byteLength long. Empty for a buffer that the file leaves undefined. Those behind the file's
    /// own hold what was decoded, and the JSON refers to them.
    std::vector<std::vector<uint8_t>> buffers;
    /// Encoded bytes of each image (PNG, JPEG ...), whatever way the file stores them. Not yet
    /// decoded: they may be no image. Empty for an image in an undefined buffer.
    std::vector<std::vector<uint8_t>> images;
    std::vector<GltfAccessor> accessors;      ///< into the buffers; one of no count is broken
    std::vector<ExtensionInFile> extensions;  ///< those that the file lists, by name
    /// Text of each light of EXT_lights_ies; empty for one that is not there.
    std::vector<std::vector<uint8_t>> light_profiles;
    std::map<std::string, MeasuredReflectance> reflectances;  ///< of materials, by name in the file
    std::vector<GltfClip> clips;                              ///< animations that are played
    WarningLog warnings;                       ///< one line each: odd, but no reason to refuse
    std::vector<std::filesystem::path> files;  ///< every file that was read, `path` first
    uint64_t hash = 0;  ///< FNV-1a of the scene file and of every file it names
};

/// The extensions that a file lists, also of a file that is refused for one of them. Throws
/// InputError where it is no glTF.
[[nodiscard]] std::vector<ExtensionInFile> read_gltf_extensions(const std::filesystem::path&);

/// Reads a .gltf or .glb with everything it refers to, and checks it before anything else uses it:
/// container, JSON (and its depth), version, required extensions, every index, every byte range,
/// the node tree, counts against the sizes of the buffers. Throws InputError with file and JSON
/// path. Where animations are chosen, they are decoded too; checks_all_animations: the others are
/// looked through for faults.
[[nodiscard]] GltfSource read_gltf_source(const std::filesystem::path&,
                                          FileScope = FileScope::Anywhere,
                                          const std::optional<AnimationChoice>& = {},
                                          bool checks_all_animations = false);

/// Makes the JSON of a file say what its animations say at a moment, and checks it once more:
/// values between keys may leave the range of a property, and are clamped as those of a file are.
/// Throws InputError.
void pose_source(GltfSource&, const AnimationChoice&);

}  // namespace petzval::io
