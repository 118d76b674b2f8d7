// SPDX-License-Identifier: Apache-2.0
// Wavelength bins of equal width, side by side.
#pragma once

#include <cmath>

#include "core/math/lanes.h"

namespace petzval {

struct Bins {
    double first_edge_nm, width_nm;
    int count;

    [[nodiscard]] double last_edge_nm() const { return first_edge_nm + width_nm * count; }
    [[nodiscard]] double centre_nm(int i) const { return first_edge_nm + width_nm * (i + 0.5); }
    /// The bin that holds a wavelength; -1 where none does.
    [[nodiscard]] int index(float nm) const {
        const int i = static_cast<int>(std::floor((nm - first_edge_nm) / width_nm));
        return i >= 0 && i < count ? i : -1;
    }
    bool operator==(const Bins&) const = default;
};

}  // namespace petzval
