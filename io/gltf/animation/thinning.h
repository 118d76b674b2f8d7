// SPDX-License-Identifier: Apache-2.0
// How few time steps follow a movement.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/math/math.h"

namespace petzval::io {

/// Choice of every n-th of the time steps.
struct Thinning {
    size_t stride = 1;
    /// Bound on how far a point is off between the chosen steps, but for NodeMotion::unseen().
    double off_m = 0;
    double size_m = 0;  ///< greatest extent of the points in the middle

    /// The finer of two, with the greater error.
    [[nodiscard]] Thinning operator|(const Thinning&) const;
    /// The same where lengths are that many times as long.
    [[nodiscard]] Thinning scaled(double factor) const {
        return {stride, off_m * factor, size_m * factor};
    }
};

/// The fewest steps, a power of two and one more, so that points which matrices move run straight
/// between them within a thousandth of their extent. steps: a power of two and one more.
[[nodiscard]] Thinning thin(std::span<const M44d> to_world, std::span<const V3d> points);
/// The same for sums of `sizes_m` that weights scale, of a body of that size.
[[nodiscard]] Thinning thin(std::span<const std::vector<double>> weights,
                            std::span<const double> sizes_m, double size_m);

}  // namespace petzval::io
