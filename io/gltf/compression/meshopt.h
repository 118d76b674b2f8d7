// SPDX-License-Identifier: Apache-2.0
// Codec of KHR_meshopt_compression and of EXT_meshopt_compression, which is a part of it: bytes in,
// bytes out.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval::io {

enum class MeshoptMode : uint8_t { Attributes, Triangles, Indices };
enum class MeshoptFilter : uint8_t { None, Octahedral, Quaternion, Exponential, Color };

/// Layout of a stream, as its bufferView has it.
struct MeshoptLayout {
    MeshoptMode mode = MeshoptMode::Attributes;
    MeshoptFilter filter = MeshoptFilter::None;
    uint64_t count = 0;   ///< elements; at most 2^53
    uint64_t stride = 0;  ///< bytes of an element
};

/// Why a stream cannot be what the layout says, found before memory is taken: a layout that the
/// extension forbids, another kind of stream, or fewer bytes than the count takes at least. Empty
/// where all is well: then a stream of n bytes is decoded to at most 1024 n (64 n in version 0).
[[nodiscard]] std::string meshopt_fault(const MeshoptLayout&, std::span<const uint8_t> stream);

/// The count * stride bytes of a stream, filtered; nothing where it is broken. meshopt_fault() must
/// have found none.
[[nodiscard]] std::optional<std::vector<uint8_t>> decode_meshopt(const MeshoptLayout&,
                                                                 std::span<const uint8_t> stream);

}  // namespace petzval::io
