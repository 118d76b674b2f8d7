// SPDX-License-Identifier: Apache-2.0
// Embree's filter callbacks for surfaces that rays may pass: which hits count.
#pragma once

#include <vector>

#include "core/traversal/bvh.h"
#include "core/traversal/embree.h"

namespace petzval {

// What a ray's filters are told. No function has a body here: a plain ray meets no filter, and
// these are no part of its road.

struct FilteredRay {
    embree::Context of_embree;  // first: Embree hands back a pointer to it
    const Ray* ray;             // in world space; Embree's own is in that of the instance
};

/// Of a ray that looks for the nearest hit, and of one that wants all hits.
struct NearestContext : FilteredRay {
    const PassedBlends* passed;
};
struct AllContext : NearestContext {
    std::vector<Hit>* all;
};

/// Of a shadow ray. Without a list its BLEND surfaces are drawn.
struct ShadowContext : FilteredRay {
    PassedBlends* blends;
    bool too_many, panes;
};

/// A packet has one ray, as only the single-ray calls are used.
namespace bvh_filters {
using Filter = void(const RTCFilterFunctionNArguments*);
Filter draw, draw_mapped, draw_weighed, list_weighed, pass_pane;
}  // namespace bvh_filters

/// Instance of a hit: instances that share a mesh have a scene of their own.
[[nodiscard]] uint32_t instance_of(uint32_t inst_id, uint32_t geom_id);

}  // namespace petzval
