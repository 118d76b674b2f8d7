// SPDX-License-Identifier: Apache-2.0
// Material variants of a glTF file: KHR_materials_variants.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/gltf/document/model.h"

namespace petzval::io {

/// Names of a file's variants, in its order; an unnamed one is empty.
[[nodiscard]] std::vector<std::string> variant_names(const GltfModel&);

/// Materials of primitives in one variant.
class GltfVariant {
  public:
    /// wanted: name or number of the variant; absent: the materials that primitives have by
    /// themselves. Throws ArgumentError where the file has no such variant.
    GltfVariant(const GltfModel&, const std::optional<std::string>& wanted);

    /// Index of the material of a primitive; -1 for glTF's default material. own: that which it
    /// has by itself, and in each variant that it does not map.
    [[nodiscard]] int material_of(int mesh, size_t primitive, int own) const;

  private:
    const GltfModel& gltf_;
    std::optional<size_t> index_;
};

}  // namespace petzval::io
