// SPDX-License-Identifier: Apache-2.0
// Which pictures are too large to be meant: a small file must not ask for gigabytes.
#pragma once

#include <cstdint>
#include <string>

namespace petzval {

/// Why a file of byte_count bytes cannot hold such a picture; empty where it can.
[[nodiscard]] std::string size_complaint(int width, int height, int depth, int channels,
                                         uint64_t byte_count);

}  // namespace petzval
