// SPDX-License-Identifier: Apache-2.0
// What a glTF file holds, in words.
#pragma once

#include "io/gltf.h"
#include "io/gltf_model.h"
#include "io/gltf_tally.h"

namespace petzval {

/// Fills contents, honoured and ignored, and appends one warning for each kind of trouble counted.
void describe(const GltfModel&, const GltfTally&, GltfFile&);

}  // namespace petzval
