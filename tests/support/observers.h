// SPDX-License-Identifier: Apache-2.0
// An observer made from small tables, for tests that know no files.
#pragma once

#include <vector>

#include "core/spectrum/colorimetry.h"
#include "core/spectrum/observer.h"

namespace petzval::test {

/// Sees as the CIE's observer of 1931, at every 20 nm, under light that is even over wavelengths.
[[nodiscard]] inline Observer plain_observer() {
    constexpr double xyz_bar[][4] = {
        {400, 0.0143, 0.0004, 0.0679}, {420, 0.1344, 0.0040, 0.6456}, {440, 0.3483, 0.0230, 1.7471},
        {460, 0.2908, 0.0600, 1.6692}, {480, 0.0956, 0.1390, 0.8130}, {500, 0.0049, 0.3230, 0.2720},
        {520, 0.0633, 0.7100, 0.0782}, {540, 0.2904, 0.9540, 0.0203}, {560, 0.5945, 0.9950, 0.0039},
        {580, 0.9163, 0.8700, 0.0017}, {600, 1.0622, 0.6310, 0.0008}, {620, 0.8544, 0.3810, 0.0002},
        {640, 0.4479, 0.1750, 0.0000}, {660, 0.1649, 0.0610, 0.0000}, {680, 0.0468, 0.0170, 0.0000},
        {700, 0.0114, 0.0041, 0.0000}};
    using Points = std::vector<std::pair<float, float>>;
    ObserverInput in;
    for (size_t c = 0; c < 3; ++c) {
        Points points;
        for (const auto& row : xyz_bar) points.emplace_back(row[0], row[c + 1]);
        in.xyz_bar[c] = in.response[c] = tabulate(points, Extrapolate::Zero);
    }
    in.basis = {tabulate(Points{{580, 0}, {600, 1}}, Extrapolate::Hold),
                tabulate(Points{{480, 0}, {500, 1}, {580, 1}, {600, 0}}, Extrapolate::Hold),
                tabulate(Points{{480, 1}, {500, 0}}, Extrapolate::Hold)};
    in.white.value.fill(1);
    const V3d white = respond(in.xyz_bar, in.white);
    const Matrix3 to_rgb = srgb_to_xyz(white / white.y).inverse();
    for (size_t i = 0; i < 3; ++i) in.matrix[i] = V3f(to_rgb.row[i]);
    return Observer(in);
}

}  // namespace petzval::test
