// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/animation/keyframes.h"

#include <algorithm>
#include <cmath>

namespace petzval::io {
namespace {

using Values = std::span<const double>;

double length_of(Values quaternion) {
    double sum = 0;
    for (const double x : quaternion) sum += x * x;
    return std::sqrt(sum);
}

void normalise(std::span<double> quaternion) {
    const double length = length_of(quaternion);
    if (!(length > 0)) return;
    for (double& x : quaternion) x /= length;
}

// Spherical linear interpolation, Shoemake 1985, as glTF 2.0, appendix C.4 has it. Keys that are
// stored as integers have not quite unit length.
void slerp(Values a, Values b, double u, std::span<double> out) {
    const auto one_over = [](double length) { return length > 0 ? 1 / length : 0; };
    const double to_a = one_over(length_of(a)), to_b = one_over(length_of(b));
    double dot = 0;
    for (size_t k = 0; k < out.size(); ++k) dot += a[k] * to_a * b[k] * to_b;
    const double sign = dot < 0 ? -1 : 1, angle = std::acos(std::min(std::fabs(dot), 1.));
    // Below this angle the sines are as their arguments, to the precision of a double.
    const bool tiny = angle < 1e-8;
    const double of_a = tiny ? 1 - u : std::sin(angle * (1 - u)) / std::sin(angle);
    const double of_b = tiny ? u : std::sin(angle * u) / std::sin(angle);
    for (size_t k = 0; k < out.size(); ++k) out[k] = of_a * to_a * a[k] + sign * of_b * to_b * b[k];
}

}  // namespace

void Keyframes::at(double time_s, std::span<double> out) const {
    const bool cubic = interpolation == Interpolation::CubicSpline;
    const auto number = [&](size_t key, size_t part) {  // part: of a cubic spline
        return Values(values).subspan((cubic ? 3 * key + part : key) * width, width);
    };
    constexpr size_t before = 0, value = 1, after = 2;
    const auto next = static_cast<size_t>(std::upper_bound(times_s.begin(), times_s.end(), time_s) -
                                          times_s.begin());
    const size_t key = next == 0 ? 0 : next - 1;
    const bool outside = next == 0 || next == times_s.size();
    if (outside || interpolation == Interpolation::Step) {
        std::ranges::copy(number(key, value), out.begin());
    } else {
        const double step_s = times_s[next] - times_s[key], u = (time_s - times_s[key]) / step_s;
        const Values a = number(key, value), b = number(next, value);
        if (cubic) {
            const Values leaves = number(key, after), arrives = number(next, before);
            const double u2 = u * u, u3 = u2 * u;
            for (size_t k = 0; k < width; ++k)  // Hermite's basis: glTF 2.0, appendix C.5
                out[k] = (2 * u3 - 3 * u2 + 1) * a[k] + step_s * (u3 - 2 * u2 + u) * leaves[k] +
                         (3 * u2 - 2 * u3) * b[k] + step_s * (u3 - u2) * arrives[k];
        } else if (rotation) {
            slerp(a, b, u, out);
        } else {
            for (size_t k = 0; k < width; ++k) out[k] = a[k] + u * (b[k] - a[k]);
        }
    }
    if (rotation) normalise(out);
}

std::vector<double> Keyframes::at(double time_s) const {
    std::vector<double> out(width);
    at(time_s, out);
    return out;
}

}  // namespace petzval::io
