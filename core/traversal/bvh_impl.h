// SPDX-License-Identifier: Apache-2.0
// What a Bvh holds, for the files that build it and ask it.
#pragma once

#include <atomic>
#include <deque>
#include <map>

#include "core/traversal/bvh.h"
#include "core/traversal/embree.h"
#include "core/traversal/mask_map.h"

namespace petzval {

struct Bvh::Impl {
    const Scene& scene;
    RTCDevice device = nullptr;
    RTCScene top = nullptr;
    std::vector<RTCScene> shared;  // one for each mesh that instances share, else null
    bool has_cutouts = false, has_blends = false;
    std::map<uint32_t, MaskMap> mask_maps;  // by material
    std::deque<MaskedMesh> masked;
    std::atomic<int64_t> bytes = 0;

    explicit Impl(const Scene& s) : scene(s) {}
    ~Impl();

    void check() const;
    [[nodiscard]] RTCScene new_scene(Traversal) const;
    [[nodiscard]] RTCGeometry triangles(uint32_t mesh_id);
    [[nodiscard]] std::optional<Hit> nearest(const Ray&, float t_min, RTCFilterFunctionN also,
                                             const PassedBlends*) const;
    /// Whether a ray meets what its context does not let it pass.
    [[nodiscard]] bool is_met(const Ray&, embree::Context&) const;
};

}  // namespace petzval
