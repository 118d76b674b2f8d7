// SPDX-License-Identifier: Apache-2.0
// Attribute streams of version 1 (KHR_meshopt_compression, appendix A, mode 0). The decoder is our
// own because the packaged library knows version 0 only.
#pragma once

#include <cstdint>
#include <span>

namespace petzval::io {

/// Elements of a group, which share a header (appendix A).
inline constexpr uint64_t kMeshoptGroup = 16;

/// Elements of a whole block of a stream, whatever its version.
[[nodiscard]] uint64_t attributes_in_block(uint64_t stride);

/// The fewest bytes that a stream of `count` elements of `stride` bytes takes: elements that are
/// all the same. stride: a multiple of 4 up to 256; count: at most 2^53.
[[nodiscard]] uint64_t least_attribute_bytes_1(uint64_t count, uint64_t stride);

/// Fills `out` with the elements of a stream and returns true; false where the stream is broken.
/// The size of `out` must be a multiple of the stride.
[[nodiscard]] bool decode_attributes_1(std::span<const uint8_t> stream, uint64_t stride,
                                       std::span<uint8_t> out);

}  // namespace petzval::io
