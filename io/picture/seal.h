// SPDX-License-Identifier: Apache-2.0
// Whether a picture file is as it was written, to the bit: decoders pass over some damage.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "io/file/atomic_file.h"
#include "io/picture/picture.h"

namespace petzval::io {

/// Name and unfilled value of the metadata that seal() fills in. PNG needs none: its chunks have
/// sums.
inline constexpr const char* kSealName = "petzval:fileHash";
inline constexpr const char* kUnsealed = "fnv1a-0000000000000000";

/// Whether metadata are the seal of another file, which a picture made from that one must not
/// carry.
[[nodiscard]] inline bool is_seal_of_another(const Metadata::value_type& metadata) {
    return metadata.first == kSealName && metadata.second != decltype(metadata.second)(kUnsealed);
}

/// Where the first megabyte of a file has the unfilled value: writes the FNV-1a hash of the file as
/// it is in its place.
void seal(AtomicFile&);

/// Whether a picture's bytes are those that were written. sealed: its metadata of kSealName; a PNG
/// is judged by the CRC-32 of its chunks.
[[nodiscard]] bool is_as_written(const std::filesystem::path&, const std::string& sealed);

/// Whether a PNG's chunks fit into it and end with IEND; with_sums: and have their sums.
[[nodiscard]] bool is_whole_png(std::span<const uint8_t>, bool with_sums);

}  // namespace petzval::io
