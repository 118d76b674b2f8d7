// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/gltf/mend/json_editor.h"
#include "io/gltf/schema/schema.h"

namespace petzval::io {

/// Mends one property of the object that has it, as its row says. What is not of its type stays:
/// the checks refuse it.
void mend_property(const JsonEditor& owner, const GltfProperty&);

}  // namespace petzval::io
