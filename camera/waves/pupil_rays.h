// SPDX-License-Identifier: Apache-2.0
// Rays of the cells of a pupil grid.
#pragma once

#include <functional>

#include "camera/waves/pupil_function.h"

namespace petzval::camera {

/// Ray in the middle of a cell.
struct PupilRay {
    double light;  ///< for a unit of p q: area before the lens, mm^2
    double opd_mm;
    std::array<double, 2> stop;  ///< x, y in radii of the stop
    double inside;               ///< as BundlePassage has it
};

/// Finds the rays of the cells, whether rims stop them or not, and tells each with the number of
/// its cell; cells that have none, or one far beyond the stop's rim, are left out. From the chief
/// ray outwards, each by its neighbour; four cells of a row at once.
void find_pupil_rays(const AimedBundle&, const ReferenceSphere&, const PupilGrid&,
                     const std::function<void(size_t, const PupilRay&)>&);

}  // namespace petzval::camera
