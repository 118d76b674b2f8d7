// SPDX-License-Identifier: Apache-2.0
// Times while a shutter is open, among steps that are spread evenly over it.
#pragma once

#include <algorithm>
#include <cstddef>

namespace petzval {

/// Times lie from 0, as the shutter opens, to 1, as it has closed.
inline constexpr float kMiddleOfShutter = 0.5f;

/// Place of a time among steps: the step before it, and the share of the way to the next one.
template <class Real>
struct StepPlace {
    size_t before;
    Real share;
};
/// Place of a time from 0 to 1 among `count` steps, at least two. Times beyond are those of the
/// ends.
template <class Real>
[[nodiscard]] StepPlace<Real> step_place(Real time, size_t count) {
    const Real at = std::clamp(time, Real(0), Real(1)) * static_cast<Real>(count - 1);
    const auto before = std::min(static_cast<size_t>(at), count - 2);
    return {before, at - static_cast<Real>(before)};
}
/// Time of one of `count` steps; the middle where there is one alone.
[[nodiscard]] inline float step_time(size_t step, size_t count) {
    if (count == 1) return kMiddleOfShutter;
    return static_cast<float>(step) / static_cast<float>(count - 1);
}

}  // namespace petzval
