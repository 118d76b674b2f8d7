// SPDX-License-Identifier: Apache-2.0
// Quantiles of Student's t.
#pragma once

namespace petzval::apps {

/// 0.975 quantile of Student's t: a series in 1 / degrees (Abramowitz and Stegun 1964, 26.7.5),
/// within 1e-3 from 4 degrees of freedom on and 2e-2 at 3; below, their table 26.10. degrees >= 1.
[[nodiscard]] double student_t_975(double degrees);

}  // namespace petzval::apps
