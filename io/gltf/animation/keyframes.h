// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace petzval::io {

/// How values run between keys: glTF 2.0, appendix C.
enum class Interpolation : uint8_t { Step, Linear, CubicSpline };

/// Values over time of one property, as an animation sampler has them.
struct Keyframes {
    std::vector<double> times_s;  ///< at least one, none before the one in front of it
    /// `width` numbers for each key; of a cubic spline the tangent before the key, the value and
    /// the tangent after it.
    std::vector<double> values;
    size_t width = 1;
    Interpolation interpolation = Interpolation::Linear;
    bool rotation = false;  ///< values are unit quaternions (x, y, z, w)

    /// Writes the `width` numbers at a time; before the first key and after the last one they stay.
    /// Quaternions run the short way round, and come out with a length of 1.
    void at(double time_s, std::span<double> out) const;
    [[nodiscard]] std::vector<double> at(double time_s) const;
};

}  // namespace petzval::io
