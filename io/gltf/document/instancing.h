// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: a node that shows its mesh at many places.
#pragma once

#include <optional>
#include <vector>

#include "core/math/math.h"
#include "io/base/json_cursor.h"
#include "io/gltf/document/model.h"

namespace petzval::io {

inline constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// Accessors of a node's instances; -1 for none.
struct GltfInstancing {
    int translation = -1, rotation = -1, scale = -1;

    /// Any of the accessors: all have one count.
    [[nodiscard]] int any() const {
        return translation >= 0 ? translation : rotation >= 0 ? rotation : scale;
    }
};

/// Instancing of a node; nothing where it shows its mesh once.
[[nodiscard]] std::optional<GltfInstancing> read_instancing(const JsonCursor& node);

/// Places of a node's instances in the node's own space.
class InstancePlaces {
  public:
    InstancePlaces(const GltfModel&, const GltfInstancing&);

    [[nodiscard]] size_t count() const { return count_; }
    /// Matrix of an instance for row vectors: scale, then rotation, then translation.
    [[nodiscard]] M44d at(size_t) const;

  private:
    size_t count_;
    std::vector<V3f> translation_, scale_;
    std::vector<V4f> rotation_;
};

}  // namespace petzval::io
