// SPDX-License-Identifier: Apache-2.0
// Header of a Draco stream: the numbers in its first bytes (Draco bitstream 2.2, sections 3 to 5),
// read without the library: its decoder takes memory by these numbers.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace petzval::io {

enum class DracoConnectivity : uint8_t { Sequential, Edgebreaker };

struct DracoHeader {
    std::string fault;  ///< why the stream cannot be decoded; empty where it can
    DracoConnectivity connectivity = DracoConnectivity::Sequential;
    uint64_t faces = 0;
    size_t body = 0;  ///< byte at which the connectivity begins, behind header and metadata
    /// Bound of the memory that decoding the connectivity takes, bytes.
    uint64_t working_bytes = 0;
};

/// Bytes of the fixed header, before metadata.
constexpr size_t kDracoHeaderBytes = 11;

[[nodiscard]] DracoHeader read_draco_header(std::span<const uint8_t> stream);

/// Memory that a stream may ask for while it is decoded: 256 MiB and 256 times its size. Streams of
/// encoders ask for less: they take a byte and a half for a face, and a face takes 250 bytes.
[[nodiscard]] constexpr uint64_t draco_memory_limit(uint64_t stream_bytes) {
    return (uint64_t(256) << 20) + 256 * stream_bytes;
}

}  // namespace petzval::io
