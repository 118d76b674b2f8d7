// SPDX-License-Identifier: Apache-2.0
// The rough picture that a view finder shows at once, while the true one is prepared.
#pragma once

#include "apps/request/render_request.h"

namespace petzval {

/// Request for a rough picture: a sample of every divisor-th pixel each way, without anything that
/// is learned or chosen before the first sample. divisor: 1 or more.
[[nodiscard]] RenderRequest rough_of(RenderRequest, int divisor);

/// Whether the second of two requests goes on with the samples of the first: they differ in how
/// many there are and how they are shown alone. Then nothing rough is needed.
[[nodiscard]] bool keeps_samples(const RenderRequest&, const RenderRequest&);

/// Divisor of the next rough picture, so that it takes kRough_s. Measured samples per second: 0
/// where none were taken yet.
[[nodiscard]] int rough_divisor(V2i size_px, double samples_per_s);

/// Time for the samples of a rough picture: with the setting up of its camera it stays within 150
/// ms.
inline constexpr double kRough_s = 0.08;

}  // namespace petzval
