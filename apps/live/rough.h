// SPDX-License-Identifier: Apache-2.0
// The rough picture that a view finder shows at once, while the true one is prepared.
#pragma once

#include "apps/request/render_request.h"

namespace petzval::apps {

/// Request for a rough picture: a sample of every divisor-th pixel each way, without anything that
/// is learned or chosen before the first sample. divisor: 1 or more.
[[nodiscard]] RenderRequest rough_of(RenderRequest, int divisor);

/// Whether the second of two requests goes on with the samples of the first: they differ in how
/// many there are and how they are shown alone. Then nothing rough is needed.
[[nodiscard]] bool keeps_samples(const RenderRequest&, const RenderRequest&);

/// Divisor of the next rough picture, so that it is there in time. Measured of those before, 0
/// where there was none: how many samples a second brings, and how long the setting up takes.
[[nodiscard]] int rough_divisor(V2i size_px, double samples_per_s, double set_up_s);

/// Time from a request to its rough picture; the way to the page and back makes it 150 ms.
inline constexpr double kRough_s = 0.11;
/// Least time for its samples: with fewer nothing would be seen.
inline constexpr double kLeastSampling_s = 0.03;

}  // namespace petzval::apps
