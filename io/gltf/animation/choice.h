// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace petzval {

/// Which animations of a file are played.
struct AnimationChoice {
    double time_s = 0;               ///< that is shown
    std::vector<std::string> names;  ///< or numbers; none: as played_animations() finds
    bool repeats = true;             ///< after their end they begin anew; else their end stays

    [[nodiscard]] bool operator==(const AnimationChoice&) const = default;
};

}  // namespace petzval
