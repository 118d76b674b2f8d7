// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "io/base/json_cursor.h"

namespace petzval {

/// Bytes that an instance takes while it is loaded, and in the BVH while that is built: measured,
/// and rounded up.
inline constexpr uint64_t kInstanceBytes = 600;

/// Limit of the memory that a glTF file may ask for: its accessors (zero-filled or over the same
/// bytes again and again), vertices that thousands of primitives share, one image listed a million
/// times. The limit is 256 MiB plus 16 times the bytes that the file and its side files hold: an
/// honest file asks for about once its own size. What is decoded counts besides: 256 MiB plus 32
/// times the file is its limit. Accessors may then ask for twice as much more: those that were
/// decoded, and those in whose place they stand.
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

}  // namespace petzval
