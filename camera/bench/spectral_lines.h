// SPDX-License-Identifier: Apache-2.0
// The three wavelengths of analyses.
#pragma once

#include <array>

#include "core/spectrum/glass.h"

namespace petzval::camera {

struct SpectralLine {
    const char* name;
    double nm;
    const char* colour;  ///< in which it is drawn, as SVG names it
};
inline constexpr std::array<SpectralLine, 3> kSpectralLines{
    {{"F", kLineF_nm, "#2060d0"}, {"d", kLineD_nm, "#d09000"}, {"C", kLineC_nm, "#c02020"}}};

}  // namespace petzval::camera
