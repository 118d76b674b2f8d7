// SPDX-License-Identifier: Apache-2.0
// A lens without aberrations on its axis: a plane and a hyperboloid (Descartes 1637).
#pragma once

#include "camera/lens/prescription.h"
#include "core/spectrum/glass.h"

namespace petzval::test {

/// Plano-hyperbolic lens of index 1.5 at every wavelength, its stop before it: parallel light meets
/// in one point. The film stands there.
[[nodiscard]] inline camera::Prescription stigmatic_lens(double focal_length_mm, double fnumber) {
    constexpr double n = 1.5;
    camera::Prescription lens;
    lens.name = "stigmatic";
    const double stop_mm = focal_length_mm / fnumber / 2;
    camera::LensSurface stop, front, back;
    stop.stop = true;
    stop.thickness_mm = 1;
    stop.semi_diameter_mm = stop_mm;
    front.glass = Glass{"n = 1.5", IndexTable{{{587.5618, n}}}};
    front.thickness_mm = 2 + stop_mm;
    back.curvature_1_mm = -1 / (focal_length_mm * (n - 1));
    back.conic = -n * n;
    back.thickness_mm = focal_length_mm;
    front.semi_diameter_mm = back.semi_diameter_mm = 3 * stop_mm;
    lens.surfaces = {stop, front, back};
    return lens;
}

}  // namespace petzval::test
