// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "io/json_cursor.h"

namespace petzval {

/// How much memory a glTF file may ask for beyond its own bytes: zero-filled accessors, one buffer
/// shared by thousands of primitives, one image listed a million times. A file that stays within
/// 256 MiB or within 16 times its own size is never refused; none met so far came near.
class GltfBudget {
  public:
    /// Counts bytes that the file and its side files really hold.
    void add_owned(uint64_t bytes) { owned_ += bytes; }

    /// Counts bytes asked for by the object at place; throws InputError there when it is too much.
    void ask(uint64_t bytes, const JsonCursor& place);

  private:
    uint64_t owned_ = 0, asked_ = 0;
};

}  // namespace petzval
