// SPDX-License-Identifier: Apache-2.0
// Counts of what the loader met: the source of warnings and of what `petzval info` prints.
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "io/base/warning_log.h"

namespace petzval::io {

struct GltfTally {
    uint64_t zero_area_triangles = 0;
    uint64_t point_primitives = 0, line_primitives = 0;
    uint64_t primitives_without_positions = 0;
    uint64_t incomplete_primitives = 0;  ///< vertices left over after the last triangle
    uint64_t broken_triangles = 0;       ///< with a corner that is not finite
    uint64_t broken_values = 0;          ///< texture coordinates and colours likewise
    uint64_t unmapped_primitives = 0;    ///< textured, but without texture coordinates
    uint64_t singular_nodes = 0;         ///< whose matrix leaves a line or a point
    uint64_t hidden_instances = 0;       ///< likewise, or not finite
    uint64_t broken_strokes = 0;         ///< points and lines that are not finite
    uint64_t replaced_normals = 0;       ///< of no length
    uint64_t occlusion_textures = 0, ranged_lights = 0, scattering_volumes = 0;
    uint64_t point_lamps = 0, spot_lamps = 0;             ///< lights with a radius
    uint64_t flat_lamps = 0;                              ///< nodes with an area
    uint64_t moving_instances = 0, deforming_meshes = 0;  ///< while the shutter is open
    uint64_t moving_lights = 0, moving_cameras = 0, zooming_cameras = 0;
    std::set<std::string> held;  ///< what changes meanwhile, but is shown as it is in the middle
    /// Bound on how far what moves is off between time steps, in metres and in its own extents.
    double motion_off_m = 0, motion_off = 0;
    bool motion_unseen = false;      ///< NodeMotion::unseen(): more may be off
    uint64_t idle_dispersions = 0;   ///< of materials that refract nothing
    std::set<std::string> honoured;  ///< features that the scene uses, in words
    WarningLog warnings;             ///< one line each
};

}  // namespace petzval::io
