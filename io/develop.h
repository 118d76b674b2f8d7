// SPDX-License-Identifier: Apache-2.0
// From a film to a picture with its layers and everything needed to make it again.
#pragma once

#include "core/film.h"
#include "integrator/render.h"
#include "io/image.h"
#include "io/session.h"

namespace petzval {

/// "petzval 0.1.0"
[[nodiscard]] std::string program_version();

/// R, G, B, A in nits of the white point, then the film's layers as "layer.channel". Metadata holds
/// what the pixels follow from; no times, so that equal renders are equal files.
[[nodiscard]] Picture develop(const Film&, const Session&, const RenderJob&, const PathOptions&,
                              uint32_t end_sample);

}  // namespace petzval
