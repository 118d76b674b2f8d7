// SPDX-License-Identifier: Apache-2.0
// EXT_lights_image_based.
#pragma once

#include <optional>

#include "core/scene/sky.h"
#include "io/gltf/document/model.h"
#include "io/gltf/document/nodes.h"
#include "io/gltf/document/tally.h"
#include "io/picture/picture_budget.h"

namespace petzval::io {

/// Sky that the drawn scene names: the first level of its cube, which is not blurred; where an
/// image of that is not there, what its spherical harmonics of the irradiance tell. Nothing where
/// it names none. 1 in a picture is 1 nit. Throws InputError where an image cannot be decoded.
[[nodiscard]] std::optional<Sky> read_image_light(const GltfModel&, const GltfNodes&, GltfTally&,
                                                  PictureBudget&);

}  // namespace petzval::io
