// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace petzval::io {

/// Which animations of a file are played.
struct AnimationChoice {
    double time_s = 0;               ///< that is shown
    std::vector<std::string> names;  ///< or numbers; none: as played_animations() finds
    bool repeats = false;            ///< after their end they begin anew; else their end stays
    double open_s = 0;               ///< how long the shutter is open, half of it before time_s

    [[nodiscard]] bool operator==(const AnimationChoice&) const = default;
};

}  // namespace petzval::io
