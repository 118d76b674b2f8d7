// SPDX-License-Identifier: Apache-2.0
// Pupil of a film point: what of the stop lets light through to it.
#pragma once

#include <functional>
#include <vector>

#include "camera/diffraction/edge_runs.h"
#include "camera/iris/iris.h"

namespace petzval::camera {

/// Even pupil in the plane of the stop, mm.
struct DiffractingPupil {
    int side = 0;                     ///< cells across
    double cell_mm = 0;               ///< width of a cell; the middle of all is the axis
    std::vector<double> amplitude{};  ///< mean over each cell, row by row from below
    double area_mm2 = 0;              ///< integral of the transmission
    std::vector<EdgeRun> runs{};      ///< mm; of the edges that are known
    bool is_whole = true;             ///< rims leave all of the iris
    bool has_outline = true;          ///< the iris is no mask
};

/// Whether rims let a point of the stop through, mm.
using RimTest = std::function<bool(V2f)>;

/// Pupil of an iris, less what rims stop.
[[nodiscard]] DiffractingPupil diffracting_pupil(const Iris&, const RimTest& passes = {});

/// Contrast of a grating in the image by an even pupil: its area that is left when it is shifted
/// against itself by `shift_mm`, over the whole (Hopkins 1955, Proc. R. Soc. A 231, 91).
[[nodiscard]] double contrast(const DiffractingPupil&, V2d shift_mm);

}  // namespace petzval::camera
