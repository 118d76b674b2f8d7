// SPDX-License-Identifier: Apache-2.0
#include "io/image/flip.h"

#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace petzval::io {
namespace {

using M33d = Imath::M33d;

/// Linear sRGB to XYZ (IEC 61966-2-1:1999, equation 7), for row vectors.
const M33d kToXyz(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722, 0.9505);

/// Contrast sensitivity of one channel, the paper's spatial filter: a sum of two Gaussians
/// a sqrt(pi / b) exp(-pi^2 x^2 / b) of the angle x in degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivity{{{1, 0.0047, 0, 1e-5},         // Y
                                                   {1, 0.0053, 0, 1e-5},         // Cx
                                                   {34.1, 0.04, 13.5, 0.025}}};  // Cz
constexpr double kWidestGaussian = 0.04;

constexpr double kColourExponent = 0.7;           ///< q_c: of the colour difference
constexpr double kKneeIn = 0.4, kKneeOut = 0.95;  ///< p_c, p_t: where it bends
constexpr double kFeatureWidth_deg = 0.082;       ///< w: of the feature detectors
constexpr double kFeatureExponent = 0.5;          ///< q_f: of the feature difference

/// X, Y and Z of white.
V3d white() {
    return V3d(1) * kToXyz;
}

/// YCxCz, the opponent space in which contrast is filtered: CIELAB without its cube roots.
V3d to_opponent(const V3d& rgb) {
    const V3d t = (rgb * kToXyz) / white();
    return {116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)};
}
V3d from_opponent(const V3d& ycc) {
    static const M33d to_rgb = kToXyz.inverse();
    const double y = (ycc.x + 16) / 116;
    return (V3d(y + ycc.y / 500, y, y - ycc.z / 200) * white()) * to_rgb;
}

/// CIELAB (CIE 015:2018, 8.2.1), its chroma scaled by lightness for the Hunt effect.
V3d hunt_lab(const V3d& rgb) {
    constexpr double d = 6. / 29;
    const auto f = [](double t) {
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4. / 29;
    };
    const V3d t = (rgb * kToXyz) / white();
    const double x = f(t.x), y = f(t.y), z = f(t.z), lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

/// HyAB colour distance, for large differences: Abasi, Amani Tehran and Fairchild 2019.
double hyab(const V3d& a, const V3d& b) {
    return std::fabs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

double largest_colour_error() {
    static const double largest =
        std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourExponent);
    return largest;
}

/// Colour difference in [0, 1]: most of the range for the smaller ones.
double colour_error(const V3f& a, const V3f& b) {
    const double largest = largest_colour_error(), knee = kKneeIn * largest;
    const double power = std::pow(hyab(V3d(a), V3d(b)), kColourExponent);
    if (power < knee) return kKneeOut / knee * power;
    return std::min(1., kKneeOut + (power - knee) / (largest - knee) * (1 - kKneeOut));
}

template <class F>
std::vector<double> kernel(int radius, const F& weight) {
    std::vector<double> out;
    for (int x = -radius; x <= radius; ++x) out.push_back(weight(double(x)));
    return out;
}

/// Weights scaled so that the positive ones add up to 1, the negative ones to -1.
std::vector<double> balanced(std::vector<double> weights) {
    double up = 0, down = 0;
    for (const double w : weights) (w > 0 ? up : down) += std::fabs(w);
    for (double& w : weights) w /= w > 0 ? up : std::max(down, 1e-300);
    return weights;
}

}  // namespace

Flip::Flip(const Picture& reference, float exposure_ev, double pixels_per_degree)
    : width_(reference.width),
      height_(reference.height),
      scale_(std::exp2(exposure_ev)),
      pixels_per_degree_(pixels_per_degree) {
    if (reference.pixels.empty() || width_ < 1 || height_ < 1)
        throw std::invalid_argument("a picture without pixels");
    if (!(pixels_per_degree > 0)) throw std::invalid_argument("pixels per degree must be above 0");
    reference_ = see(reference);
}

Flip::Plane Flip::convolve(const Plane& in, const std::vector<double>& across,
                           const std::vector<double>& down) const {
    const auto pass = [&](const Plane& from, const std::vector<double>& weights, int dx, int dy) {
        const int radius = static_cast<int>(weights.size() / 2);
        Plane out{std::vector<float>(from.v.size())};
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                double sum = 0;
                for (int k = -radius; k <= radius; ++k) {
                    const int at_x = std::clamp(x + k * dx, 0, width_ - 1);
                    const int at_y = std::clamp(y + k * dy, 0, height_ - 1);
                    sum += weights[static_cast<size_t>(k + radius)] *
                           double(from.v[static_cast<size_t>(at_y) * width_ + at_x]);
                }
                out.v[static_cast<size_t>(y) * width_ + x] = static_cast<float>(sum);
            }
        return out;
    };
    return pass(pass(in, across, 1, 0), down, 0, 1);
}

Flip::Plane Flip::contrast_filtered(const Plane& in, size_t channel) const {
    // Each Gaussian is separable, their sum is not.
    const int radius = static_cast<int>(
        std::ceil(3 * std::sqrt(kWidestGaussian / (2 * std::numbers::pi * std::numbers::pi)) *
                  pixels_per_degree_));
    const Sensitivity& s = kSensitivity[channel];
    Plane out{std::vector<float>(in.v.size(), 0.f)};
    double total = 0;
    for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
        if (a == 0) continue;
        const auto weights = kernel(radius, [&, width = b](double x) {
            const double deg = x / pixels_per_degree_;
            return std::exp(-std::numbers::pi * std::numbers::pi * deg * deg / width);
        });
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.);
        const double height = a * std::sqrt(std::numbers::pi / b);
        const Plane part = convolve(in, weights, weights);
        for (size_t i = 0; i < out.v.size(); ++i) out.v[i] += float(height * double(part.v[i]));
        total += height * sum * sum;
    }
    for (float& v : out.v) v = static_cast<float>(double(v) / total);
    return out;
}

Flip::Seen Flip::see(const Picture& picture) const {
    const std::array<int, 3> from{channel_index(picture, "R"), channel_index(picture, "G"),
                                  channel_index(picture, "B")};
    if (*std::min_element(from.begin(), from.end()) < 0)
        throw std::invalid_argument("a picture without channels R, G and B");
    if (picture.width != width_ || picture.height != height_)
        throw std::invalid_argument("pictures of different sizes");

    const size_t count = static_cast<size_t>(width_) * height_;
    std::array<Plane, 3> opponent;
    for (Plane& plane : opponent) plane.v.resize(count);
    Plane luminance{std::vector<float>(count)};
    for (size_t i = 0; i < count; ++i) {
        V3d rgb;
        for (int c = 0; c < 3; ++c) {
            const float value =
                picture.pixels[i * picture.channels.size() + static_cast<size_t>(from[c])];
            // A negated comparison, so that NaN is black.
            rgb[c] = !(value > 0) ? 0. : std::min(1., double(value * scale_));
        }
        const V3d ycc = to_opponent(rgb);
        for (size_t c = 0; c < 3; ++c) opponent[c].v[i] = static_cast<float>(ycc[int(c)]);
        luminance.v[i] = static_cast<float>((ycc.x + 16) / 116);
    }

    Seen seen;
    for (size_t c = 0; c < 3; ++c) opponent[c] = contrast_filtered(opponent[c], c);
    seen.lab.resize(count);
    for (size_t i = 0; i < count; ++i) {
        V3d rgb = from_opponent({opponent[0].v[i], opponent[1].v[i], opponent[2].v[i]});
        for (int c = 0; c < 3; ++c) rgb[c] = std::clamp(rgb[c], 0., 1.);
        seen.lab[i] = V3f(hunt_lab(rgb));
    }

    // Edges and points: first and second derivative of a Gaussian.
    const double sigma = 0.5 * kFeatureWidth_deg * pixels_per_degree_;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    const auto smooth = balanced(kernel(radius, gauss));
    const auto strength = [&](const std::vector<double>& detector) {
        const Plane across = convolve(luminance, detector, smooth);
        const Plane down = convolve(luminance, smooth, detector);
        std::vector<float> out(count);
        for (size_t i = 0; i < count; ++i) out[i] = std::hypot(across.v[i], down.v[i]);
        return out;
    };
    seen.edge = strength(balanced(kernel(radius, [&](double x) { return -x * gauss(x); })));
    seen.point = strength(balanced(
        kernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gauss(x); })));
    return seen;
}

std::vector<float> Flip::map(const Picture& test) const {
    const Seen seen = see(test);
    std::vector<float> out(seen.lab.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const double feature = std::max(std::fabs(double(reference_.edge[i]) - seen.edge[i]),
                                        std::fabs(double(reference_.point[i]) - seen.point[i]));
        const double visible = std::pow(std::min(1., feature * M_SQRT1_2), kFeatureExponent);
        out[i] =
            static_cast<float>(std::pow(colour_error(reference_.lab[i], seen.lab[i]), 1 - visible));
    }
    return out;
}

double Flip::mean(const Picture& test) const {
    const std::vector<float> errors = map(test);
    return std::accumulate(errors.begin(), errors.end(), 0.) / static_cast<double>(errors.size());
}

}  // namespace petzval::io
