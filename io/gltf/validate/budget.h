// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "io/base/json_cursor.h"

namespace petzval::io {

/// Bytes that an instance takes while it is loaded, and in the BVH while that is built: measured,
/// and rounded up.
inline constexpr uint64_t kInstanceBytes = 600;

/// Limit of the memory that a glTF file may ask for: its accessors (zero-filled or over the same
/// bytes again and again), vertices that thousands of primitives share, one image listed a million
/// times. An honest file asks for about once its own size. `file` is the size of the file with its
/// side files, `decoded` the size of all that is decoded:
///
///     asked for   at most 256 MiB + 16 file + 2 decoded
///     decoded     at most 256 MiB + 32 file
///
/// Decoded data count twice: as accessors, and as the accessors that they replace.
class GltfBudget {
  public:
    /// Counts bytes that the file and its side files really hold.
    void add_owned(uint64_t bytes) { owned_ += bytes; }

    /// Counts bytes asked for by the object at place; throws InputError there when it is too much.
    void ask(uint64_t bytes, const JsonCursor& place);

    /// Counts bytes likewise to which compressed data at place are to be decoded.
    void ask_decoded(uint64_t bytes, const JsonCursor& place);

    /// How many bytes ask_decoded() would still grant.
    [[nodiscard]] uint64_t left_to_decode() const;

  private:
    uint64_t owned_ = 0, asked_ = 0, decoded_ = 0;
};

}  // namespace petzval::io
