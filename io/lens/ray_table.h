// SPDX-License-Identifier: Apache-2.0
// Rays through a lens as tables.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "camera/lens/traced_ray.h"

namespace petzval::io {

struct RayToTrace {
    V3d origin_mm;  ///< z = 0 at the first vertex, +z towards the film
    V3d direction;  ///< not 0
    double nm;      ///< 360 to 830
};

/// Reads rays from a CSV with the columns x,y,z,dx,dy,dz,nm in any order; no others. Throws
/// InputError with the line.
[[nodiscard]] std::vector<RayToTrace> read_rays(const std::filesystem::path&);

/// CSV of traced rays. Columns x,y,z,dx,dy,dz: where and how the ray leaves; film_x,film_y: where
/// it meets the film; path: its optical path from the origin to x,y,z; status: ok, vignetted, tir
/// or miss; surface: where it was blocked, from 0. Cells without a value are empty. Digits as many
/// as a double needs.
[[nodiscard]] std::string ray_table(std::span<const camera::TracedRay>, camera::Towards,
                                    double film_mm);

}  // namespace petzval::io
