// SPDX-License-Identifier: Apache-2.0
// The binary glTF container (glTF 2.0, section 4, "GLB File Format Specification").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/base/warning_log.h"

namespace petzval::io {

/// Chunks of a .glb, views into the container's bytes.
struct GlbChunks {
    std::string_view json;
    std::optional<std::span<const uint8_t>> bin;
};

/// Whether the bytes begin as a .glb does.
[[nodiscard]] bool is_glb(std::span<const uint8_t> bytes);

/// Splits a container into its chunks. file: its name, for InputError; warnings: unknown chunks and
/// trailing bytes, which are skipped, are reported there.
[[nodiscard]] GlbChunks split_glb(std::span<const uint8_t> bytes, const std::string& file,
                                  WarningLog& warnings);

}  // namespace petzval::io
