// SPDX-License-Identifier: Apache-2.0
#include "tests/measure/sigmoid.h"

#include <algorithm>
#include <cstring>

namespace petzval::bench {
namespace {

constexpr double kRange_nm = kLast_nm - kFirst_nm;
// Beyond this the sigmoid is flat to 1e-5, and differences of coefficients mean nothing.
constexpr double kLargest = 200;

double square(double x) {
    return x * x;
}

// Derivative of the curve of CIE 015:2018, equations 8.6 and 8.7.
double lab_slope(double ratio) {
    constexpr double edge = 24. / 116;
    return ratio > edge * edge * edge ? 1 / (3 * square(std::cbrt(ratio))) : 841. / 108;
}

double smoothstep(double x) {
    return x * x * (3 - 2 * x);
}

V3d within_range(const V3d& c) {
    const double largest = std::max({std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)});
    return largest > kLargest ? c * (kLargest / largest) : c;
}

}  // namespace

SigmoidFit::SigmoidFit(const std::array<SpectrumTable, 3>& xyz_bar, const SpectrumTable& white) {
    const double scale = 1 / integral_of_product(xyz_bar[1], white);
    for (size_t i = 0; i < kSpectrumSize; ++i) {
        Row& row = rows_[i / 4];
        row.place[i % 4] = double(i) / kRange_nm;
        for (size_t k = 0; k < 3; ++k) {
            row.xyz_bar[k][i % 4] = double(xyz_bar[k].value[i]) * white.value[i] * scale;
            white_[int(k)] += row.xyz_bar[k][i % 4];
        }
    }
    rgb_to_xyz_ = srgb_to_xyz(white_);
}

SigmoidFit::Response SigmoidFit::respond_to(const V3d& c) const {
    const auto sum = [](d4 a) { return (a[0] + a[1]) + (a[2] + a[3]); };
    std::array<d4, 3> value{}, per_x2{}, per_x1{}, per_x0{};
    for (const Row& row : rows_) {
        const d4 t = row.place, x = (c.x * t + c.y) * t + c.z, q = 1 + x * x;
        const d4 r = 1 / d4{std::sqrt(q[0]), std::sqrt(q[1]), std::sqrt(q[2]), std::sqrt(q[3])};
        const d4 s = 0.5 + 0.5 * x * r, slope = 0.5 * r * r * r;
        for (size_t k = 0; k < 3; ++k) {
            const d4 change = row.xyz_bar[k] * slope;
            value[k] += row.xyz_bar[k] * s;
            per_x0[k] += change;
            per_x1[k] += change * t;
            per_x2[k] += change * t * t;
        }
    }
    V3d xyz;
    Matrix3 slope;
    for (size_t k = 0; k < 3; ++k) {
        xyz[int(k)] = sum(value[k]);
        slope.row[k] = V3d(sum(per_x2[k]), sum(per_x1[k]), sum(per_x0[k]));
    }
    for (int k = 0; k < 3; ++k) slope.row[k] *= lab_slope(xyz[k] / white_[k]) / white_[k];
    return {xyz_to_lab(xyz, white_),
            {{slope.row[1] * 116., (slope.row[0] - slope.row[1]) * 500.,
              (slope.row[1] - slope.row[2]) * 200.}}};
}

V3d SigmoidFit::fit(const V3d& rgb, const V3d& start) const {
    constexpr int steps = 60;
    constexpr double good = 1e-6, least_damping = 1e-9;
    const V3d goal = xyz_to_lab(rgb_to_xyz_ * rgb, white_);
    V3d c = within_range(start);
    Response now = respond_to(c);
    double damping = least_damping;
    for (int i = 0; i < steps; ++i) {
        const V3d off = goal - now.lab;
        if (off.length() < good || damping > 1e9) break;
        const auto& g = now.gradient.row;
        Matrix3 normal;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                normal.row[a][b] = g[0][a] * g[0][b] + g[1][a] * g[1][b] + g[2][a] * g[2][b];
                if (a == b) normal.row[a][b] *= 1 + damping;
                if (a == b) normal.row[a][b] += 1e-15;
            }
        const V3d right = g[0] * off.x + g[1] * off.y + g[2] * off.z;
        const V3d moved = within_range(c + normal.inverse() * right);
        const Response then = respond_to(moved);
        if ((goal - then.lab).length2() < off.length2()) {
            c = moved;
            now = then;
            damping = std::max(damping / 10, least_damping);
        } else {
            damping = std::max(damping, 1e-6) * 10;
        }
    }
    return c;
}

f4 in_powers_of_nm(const V3d& c) {
    const double w = kRange_nm, first = kFirst_nm;
    return f4{static_cast<float>(c.x / (w * w)),
              static_cast<float>(c.y / w - 2 * c.x * first / (w * w)),
              static_cast<float>(c.x * square(first / w) - c.y * first / w + c.z), 0.f};
}

V3d in_unit_range(f4 c) {
    const double w = kRange_nm, first = kFirst_nm, c0 = c[0], c1 = c[1];
    return {c0 * w * w, (c1 + 2 * c0 * first) * w, (c0 * first + c1) * first + c[2]};
}

SigmoidTable::SigmoidTable(int size, const SigmoidFit& fit)
    : size_(static_cast<size_t>(size)), coefficients_(9 * size_ * size_ * size_ + 1) {
    const double last = size - 1;
    for (size_t k = 0; k < size_; ++k)
        scale_.push_back(static_cast<float>(smoothstep(smoothstep(double(k) / last))));
    for (size_t channel = 0; channel < 3; ++channel)
        for (size_t j = 0; j < size_; ++j)
            for (size_t i = 0; i < size_; ++i) {
                const auto fill = [&](size_t k, const V3d& start) {
                    const double z = scale_[k];
                    V3d rgb;
                    rgb[int(channel)] = z;
                    rgb[int(channel + 1) % 3] = double(i) / last * z;
                    rgb[int(channel + 2) % 3] = double(j) / last * z;
                    const V3d c = fit.fit(rgb, start);
                    const f4 stored = in_powers_of_nm(c);
                    const size_t cell = ((channel * size_ + k) * size_ + j) * size_ + i;
                    for (size_t n = 0; n < 3; ++n)
                        coefficients_[3 * cell + n] = stored[static_cast<int>(n)];
                    return c;
                };
                // From a dim colour, where every start leads home, to brighter and to darker ones.
                const size_t middle = size_ / 5;
                const V3d dim = fill(middle, V3d(0.));
                V3d c = dim;
                for (size_t k = middle + 1; k < size_; ++k) c = fill(k, c);
                c = dim;
                for (size_t k = middle; k-- > 0;) c = fill(k, c);
            }
}

f4 SigmoidTable::load(size_t cell) const {
    f4 c;
    std::memcpy(&c, &coefficients_[3 * cell], sizeof c);
    return c;
}

f4 SigmoidTable::look_up(Rgb rgb) const {
    // Without branches, which colours of texels would send the wrong way every other time.
    const std::array<float, 5> turned{rgb[0], rgb[1], rgb[2], rgb[0], rgb[1]};
    const size_t green_or_blue = size_t((rgb[1] > rgb[0]) | (rgb[2] > rgb[0]));
    const size_t channel = green_or_blue << size_t(rgb[2] > rgb[1]);
    const float z = turned[channel];
    const int size = static_cast<int>(size_);
    const float to_place = static_cast<float>(size - 1) / std::max(z, 1e-20f);
    const float x = turned[channel + 1] * to_place, y = turned[channel + 2] * to_place;
    const int i = std::min(static_cast<int>(x), size - 2);
    const int j = std::min(static_cast<int>(y), size - 2);
    size_t k = 0;  // the last of scale_ that is not above z, but not the end
    for (size_t n = size_ - 1; n > 1;) {
        const size_t half = n / 2;
        k += half * size_t(scale_[k + half] <= z);
        n -= half;
    }
    const float u = x - static_cast<float>(i), v = y - static_cast<float>(j);
    const float w = (z - scale_[k]) / (scale_[k + 1] - scale_[k]);
    const size_t cell = ((channel * size_ + k) * size_ + size_t(j)) * size_ + size_t(i);
    const auto plane = [&](size_t at) {
        const f4 upper = load(at) * (1.f - u) + load(at + 1) * u;
        const f4 lower = load(at + size_) * (1.f - u) + load(at + size_ + 1) * u;
        return upper * (1.f - v) + lower * v;
    };
    return plane(cell) * (1.f - w) + plane(cell + size_ * size_) * w;
}

}  // namespace petzval::bench
