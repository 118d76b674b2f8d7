// SPDX-License-Identifier: Apache-2.0
// Contents of a glTF file, in words.
#pragma once

#include "io/gltf/gltf.h"
#include "io/gltf/model.h"
#include "io/gltf/tally.h"

namespace petzval {

/// Fills contents, honoured and ignored, and appends one warning for each kind of trouble counted.
void describe(const GltfModel&, const GltfTally&, GltfFile&);

}  // namespace petzval
