// SPDX-License-Identifier: Apache-2.0
// Limits on the size of pictures: a small file must not ask for gigabytes.
#pragma once

#include <cstdint>
#include <string>

namespace petzval {

/// Reason why a file of byte_count bytes cannot hold such a picture; empty where it can.
[[nodiscard]] std::string size_complaint(int width, int height, int depth, int channels,
                                         uint64_t byte_count);

}  // namespace petzval
