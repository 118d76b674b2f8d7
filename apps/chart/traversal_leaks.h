// SPDX-License-Identifier: Apache-2.0
// Rays at the edges that triangles share, where a traversal that rounds may let them through.
#pragma once

#include <cstdint>
#include <vector>

#include "core/traversal/bvh.h"

namespace petzval::apps {

/// `count` rays aimed at random points of random edges that two opaque triangles of a mesh share,
/// one on either side of the edge as the ray sees it. Each starts one length of its edge away and
/// ends just behind the edge (t_max). A pure function of scene and seed. Fewer than count, or none,
/// where the scene has hardly such edges; large meshes count in part.
[[nodiscard]] std::vector<Ray> shared_edge_rays(const Scene&, size_t count, uint32_t seed);

/// Number of rays that meet nothing: each went through between two triangles.
[[nodiscard]] size_t traversal_leaks(const Bvh&, const std::vector<Ray>& shared_edge_rays);

}  // namespace petzval::apps
