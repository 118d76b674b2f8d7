// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/colorimetry.h"

#include <cmath>
#include <numbers>

namespace petzval {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double hue_deg(double a, double b) {
    if (a == 0 && b == 0) return 0;
    const double hue = std::atan2(b, a) / kDegree;
    return hue < 0 ? hue + 360 : hue;
}

// Function f of L*a*b*: CIE 015:2018, equations 8.6 and 8.7.
double lab_curve(double ratio) {
    constexpr double edge = 24. / 116;
    return ratio > edge * edge * edge ? std::cbrt(ratio) : 841. / 108 * ratio + 16. / 116;
}

double pow7(double a) {
    const double a2 = a * a;
    return a2 * a2 * a2 * a;
}

// sqrt(C^7 / (C^7 + 25^7)), of equations 4 and 17.
double chroma_weight(double chroma) {
    return std::sqrt(pow7(chroma) / (pow7(chroma) + pow7(25)));
}

double square(double a) {
    return a * a;
}

}  // namespace

Matrix3 Matrix3::operator*(const Matrix3& o) const {
    Matrix3 product;
    for (size_t i = 0; i < 3; ++i)
        product.row[i] = o.row[0] * row[i].x + o.row[1] * row[i].y + o.row[2] * row[i].z;
    return product;
}

Matrix3 Matrix3::inverse() const {
    const V3d a = row[1].cross(row[2]), b = row[2].cross(row[0]), c = row[0].cross(row[1]);
    const double d = 1 / row[0].dot(a);
    return {{V3d(a.x, b.x, c.x) * d, V3d(a.y, b.y, c.y) * d, V3d(a.z, b.z, c.z) * d}};
}

V3d respond(const std::array<SpectrumTable, 3>& curves, const SpectrumTable& spectrum) {
    return {integral_of_product(curves[0], spectrum), integral_of_product(curves[1], spectrum),
            integral_of_product(curves[2], spectrum)};
}

Matrix3 srgb_to_xyz(const V3d& white) {
    const auto from_xy = [](double x, double y) { return V3d(x / y, 1, (1 - x - y) / y); };
    const V3d r = from_xy(0.64, 0.33), g = from_xy(0.30, 0.60), b = from_xy(0.15, 0.06);
    const Matrix3 primaries{{V3d(r.x, g.x, b.x), V3d(r.y, g.y, b.y), V3d(r.z, g.z, b.z)}};
    const V3d share = primaries.inverse() * white;
    return primaries * Matrix3{{V3d(share.x, 0, 0), V3d(0, share.y, 0), V3d(0, 0, share.z)}};
}

Matrix3 bradford(const V3d& from_white, const V3d& to_white) {
    const Matrix3 cones{
        {V3d(0.8951, 0.2664, -0.1614), V3d(-0.7502, 1.7135, 0.0367), V3d(0.0389, -0.0685, 1.0296)}};
    const V3d from = cones * from_white, to = cones * to_white;
    const Matrix3 scale{
        {V3d(to.x / from.x, 0, 0), V3d(0, to.y / from.y, 0), V3d(0, 0, to.z / from.z)}};
    return cones.inverse() * (scale * cones);
}

V3d xyz_to_lab(const V3d& xyz, const V3d& white) {
    const double x = lab_curve(xyz.x / white.x), y = lab_curve(xyz.y / white.y),
                 z = lab_curve(xyz.z / white.z);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double delta_e_2000(const V3d& lab1, const V3d& lab2) {
    const double mean_chroma = (std::hypot(lab1.y, lab1.z) + std::hypot(lab2.y, lab2.z)) / 2;
    const double stretch = 1 + 0.5 * (1 - chroma_weight(mean_chroma));
    const double a1 = lab1.y * stretch, a2 = lab2.y * stretch;
    const double c1 = std::hypot(a1, lab1.z), c2 = std::hypot(a2, lab2.z);
    const double h1 = hue_deg(a1, lab1.z), h2 = hue_deg(a2, lab2.z);
    const bool grey = c1 * c2 == 0;

    double turn = grey ? 0 : h2 - h1;
    if (turn > 180) turn -= 360;
    if (turn < -180) turn += 360;
    double hue = h1 + h2;
    if (!grey) {
        if (std::fabs(h1 - h2) > 180) hue += hue < 360 ? 360 : -360;
        hue /= 2;
    }
    const double dl = lab2.x - lab1.x, dc = c2 - c1;
    const double dh = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2 * kDegree);
    const double lightness = (lab1.x + lab2.x) / 2, chroma = (c1 + c2) / 2;
    const auto cosine = [](double deg) { return std::cos(deg * kDegree); };
    const double t = 1 - 0.17 * cosine(hue - 30) + 0.24 * cosine(2 * hue) +
                     0.32 * cosine(3 * hue + 6) - 0.20 * cosine(4 * hue - 63);
    const double off2 = square(lightness - 50);
    const double sl = 1 + 0.015 * off2 / std::sqrt(20 + off2), sc = 1 + 0.045 * chroma,
                 sh = 1 + 0.015 * chroma * t;
    const double rotation =
        -2 * chroma_weight(chroma) * std::sin(60 * std::exp(-square((hue - 275) / 25)) * kDegree);
    return std::sqrt(square(dl / sl) + square(dc / sc) + square(dh / sh) +
                     rotation * (dc / sc) * (dh / sh));
}

}  // namespace petzval
