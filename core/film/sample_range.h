// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace petzval {

/// Sample indices [first, end) of a pixel.
struct SampleRange {
    uint32_t first = 0, end = 0;
    [[nodiscard]] uint32_t count() const { return end - first; }
    bool operator==(const SampleRange&) const = default;
};

}  // namespace petzval
