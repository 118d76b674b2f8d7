// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/sensor_fit.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace petzval {
namespace {

SpectrumTable times(const SpectrumTable& a, const SpectrumTable& b) {
    SpectrumTable product;
    for (size_t i = 0; i < a.value.size(); ++i) product.value[i] = a.value[i] * b.value[i];
    return product;
}

}  // namespace

// Each row m of the matrix minimises sum (m . s - t)^2 subject to m . w = t_w for the white's
// response w: with Lagrange's multiplier, m = A^-1 (b + l w), A = sum s s^T, b = sum t s,
// l = (t_w - w . A^-1 b) / (w . A^-1 w).
SensorFit fit_sensor(const std::array<SpectrumTable, 3>& response,
                     const std::array<SpectrumTable, 3>& xyz_bar, const SpectrumTable& light,
                     const Matrix3& xyz_to_rgb, std::span<const SpectrumTable> reflectances) {
    const V3d white = respond(response, light), white_xyz = respond(xyz_bar, light);
    std::vector<V3d> seen, xyz;
    Matrix3 a{{V3d(0.), V3d(0.), V3d(0.)}};
    for (const SpectrumTable& reflectance : reflectances) {
        const SpectrumTable reflected = times(light, reflectance);
        seen.push_back(respond(response, reflected));
        xyz.push_back(respond(xyz_bar, reflected));
        for (int i = 0; i < 3; ++i) a.row[static_cast<size_t>(i)] += seen.back() * seen.back()[i];
    }
    const double volume = a.row[0].dot(a.row[1].cross(a.row[2]));
    const double scale = a.row[0].length() * a.row[1].length() * a.row[2].length();
    if (!(volume > 1e-12 * scale))
        throw std::invalid_argument("the three curves do not tell three colours apart");
    const Matrix3 inverse = a.inverse();

    SensorFit fit;
    const V3d white_rgb = xyz_to_rgb * white_xyz;
    for (int channel = 0; channel < 3; ++channel) {
        V3d b(0.);
        for (size_t i = 0; i < seen.size(); ++i) b += seen[i] * (xyz_to_rgb * xyz[i])[channel];
        const V3d free = inverse * b, along = inverse * white;
        const double multiplier = (white_rgb[channel] - white.dot(free)) / white.dot(along);
        fit.matrix.row[static_cast<size_t>(channel)] = free + along * multiplier;
    }
    const Matrix3 to_xyz = xyz_to_rgb.inverse();
    for (size_t i = 0; i < seen.size(); ++i) {
        const double error = delta_e_2000(xyz_to_lab(xyz[i], white_xyz),
                                          xyz_to_lab(to_xyz * (fit.matrix * seen[i]), white_xyz));
        fit.mean_delta_e += error / static_cast<double>(seen.size());
        fit.worst_delta_e = std::max(fit.worst_delta_e, error);
    }
    return fit;
}

}  // namespace petzval
