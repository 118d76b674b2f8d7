// SPDX-License-Identifier: Apache-2.0
// Report of `petzval info`, for people and for programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/setup/camera/auto_focus.h"
#include "io/gltf/gltf.h"

namespace petzval::apps {

/// A file that was read, and what its finished scene shows.
struct InfoReport {
    std::filesystem::path path;
    io::GltfFile file;
    std::optional<std::string> variant;  ///< that is shown, as asked for
    std::optional<Box3f> bounds;         ///< absent: nothing is there
    std::vector<FoundFocus> focus;       ///< of the first cameras; of the framing one without any
    uint64_t bvh_bytes = 0;
};

/// Prints to stdout what a file holds and what becomes of it.
void print_info(const InfoReport&);
/// Prints the same as JSON; docs/guide/info.md has the schema.
void print_info_json(const InfoReport&);
/// Prints why a file is refused, and its extensions, as JSON.
void print_refusal_json(const std::filesystem::path&, const std::string& error,
                        const std::vector<io::ExtensionInFile>&);

}  // namespace petzval::apps
