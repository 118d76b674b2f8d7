// SPDX-License-Identifier: Apache-2.0
// Diffraction patterns against closed forms: Airy's disc, Fourier transforms of polygons, transfer
// functions.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "camera/diffraction/diffraction_pattern.h"
#include "camera/diffraction/star_aim.h"
#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"

namespace petzval::camera {
namespace {

constexpr double kTau = 2 * std::numbers::pi;
constexpr double kPupil_mm = 2;

Iris iris_of(const ApertureShape& shape) {
    return {shape, kPupil_mm, ApertureScale::EqualArea};
}
DiffractionPattern pattern_of(const ApertureShape& shape) {
    return DiffractionPattern(diffracting_pupil(iris_of(shape)));
}

/// Density of a round pupil at a frequency: Airy 1835.
double airy(double v) {
    const double x = kTau * kPupil_mm * v;
    return x < 1e-9 ? std::numbers::pi * kPupil_mm * kPupil_mm
                    : std::pow(std::cyl_bessel_j(1, x), 2) / (std::numbers::pi * v * v);
}
/// Share of its light within a frequency: Rayleigh 1881.
double airy_within(double v) {
    const double x = kTau * kPupil_mm * v;
    return 1 - std::pow(std::cyl_bessel_j(0, x), 2) - std::pow(std::cyl_bessel_j(1, x), 2);
}

/// |F|^2 over the area of a polygon, by its edges: Gauss's theorem.
double polygon_density(const std::vector<V2d>& corners, double area, V2d v) {
    std::complex<double> sum;
    for (size_t i = 0; i < corners.size(); ++i) {
        const V2d from = corners[i], edge = corners[(i + 1) % corners.size()] - from;
        const double x = std::numbers::pi * v.dot(edge);
        const double sinc = std::fabs(x) < 1e-9 ? 1 : std::sin(x) / x;
        sum += std::polar((v.x * edge.y - v.y * edge.x) * sinc, -kTau * v.dot(from + edge * 0.5));
    }
    return std::norm(sum / (kTau * v.dot(v))) / area;
}

// Means over small discs, wider than the cells of the table.
TEST(Diffraction, RoundPupilHasAirysDisc) {
    const DiffractionPattern pattern = pattern_of(Disk{});
    const double period = 1 / (2 * kPupil_mm), wide = 0.2 * period;
    for (double r = 0.03; r < 12; r *= 1.3)
        for (const double angle : {0.3, 1.9, 4.4}) {
            double ours = 0, exact = 0;
            constexpr uint32_t count = 4096;
            for (uint32_t i = 0; i < count; ++i) {
                const V2f u = Sampler(SamplerKind::Owen, 5, {0, 0, i}).get2(Dim::Lens);
                const V2d v = V2d(std::cos(angle), std::sin(angle)) * (r * period) +
                              V2d(uniform_disk(u)) * wide;
                ours += double(pattern.density(V2f(v))) / count;
                exact += airy(v.length()) / count;
            }
            EXPECT_NEAR(ours, exact, 0.01 * exact + 0.003 * airy(0)) << r;
        }
}

TEST(Diffraction, DrawsOfARoundPupilLieWithinRadiiAsTheLightDoes) {
    const DiffractionPattern pattern = pattern_of(Disk{});
    const double period = 1 / (2 * kPupil_mm);
    constexpr uint32_t count = 1 << 18;
    for (const double radius : {0.5, 1.0, 2.0, 5.0, 20.0, 40.0, 200.0}) {
        uint32_t within = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const Sampler sampler(SamplerKind::Owen, 7, {0, 0, i});
            within +=
                double(
                    pattern.draw(sampler.get1(Dim::DiffractionPick), sampler.get2(Dim::Diffraction))
                        .length()) < radius * period;
        }
        EXPECT_NEAR(within / double(count), airy_within(radius * period), 3e-3) << radius;
    }
}

// Draws counted in bins of radius and angle, against the density integrated over each.
void expect_draws_follow_density(const ApertureShape& shape) {
    const DiffractionPattern pattern = pattern_of(shape);
    constexpr int rings = 8, sectors = 24, steps = 48;
    constexpr uint32_t count = 1 << 20;
    const double first = 0.25 / kPupil_mm, growth = 2.5;
    std::vector<double> drawn(rings * sectors), expected(rings * sectors);
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Independent, 11, {0, 0, i});
        const V2f v =
            pattern.draw(sampler.get1(Dim::DiffractionPick), sampler.get2(Dim::Diffraction));
        const double ring = std::log(double(v.length()) / first) / std::log(growth);
        if (!(ring >= 0 && ring < rings)) continue;
        const double angle = std::atan2(double(v.y), double(v.x)) / kTau + 0.5;
        drawn[size_t(ring) * sectors + std::min(size_t(angle * sectors), size_t(sectors - 1))]++;
    }
    for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector) {
            double& sum = expected[size_t(ring * sectors + sector)];
            for (int k = 0; k < 16 * steps * steps; ++k) {
                const double r = first * std::pow(growth, ring + (k / (16 * steps) + 0.5) / steps);
                const double angle =
                    ((sector + (k % (16 * steps) + 0.5) / (16 * steps)) / sectors - 0.5) * kTau;
                sum += double(pattern.density(V2f(V2d(std::cos(angle), std::sin(angle)) * r))) * r *
                       r * std::log(growth) / steps * kTau / sectors / (16 * steps);
            }
            const double mean = sum * count;
            EXPECT_NEAR(drawn[size_t(ring * sectors + sector)], mean,
                        5 * std::sqrt(mean) + 0.02 * mean + 3)
                << ring << ' ' << sector;
        }
}
TEST(Diffraction, DrawsFollowTheDensity) {
    expect_draws_follow_density(regular_polygon(5, 10));
    expect_draws_follow_density(regular_polygon(7, 0, 0.5));
    expect_draws_follow_density(Mask{3, 2, {1, 0, 0.5f, 0.2f, 1, 0}});
}

// Spikes beyond the table, and what lies between them, against the transform of the polygon.
TEST(Diffraction, SpikesAreThoseOfThePolygon) {
    for (const int blades : {5, 6, 9, 18}) {
        const Iris iris = iris_of(regular_polygon(blades, 12));
        const std::vector<V2d> corners = iris.outline_mm()[0];
        const DiffractionPattern pattern{diffracting_pupil(iris)};
        const int spikes = blades % 2 ? 2 * blades : blades;
        for (const double periods : {40., 150.}) {
            const double r0 = periods / (2 * kPupil_mm);
            // Over a sector about a spike, and one between two.
            const auto light = [&](double angle, double half, const auto& density) {
                constexpr int across = 4000, along = 64;
                double sum = 0;
                for (int i = 0; i < across; ++i)
                    for (int k = 0; k < along; ++k) {
                        // Radii jump about, so that fringes are met evenly.
                        const double r =
                            r0 * (1 + 0.3 * std::fmod(0.5 + (i * along + k) * 0.6180339887, 1));
                        const double a = angle + half * (2 * (i + 0.5) / across - 1);
                        sum += density(V2d(std::cos(a), std::sin(a)) * r) * r;
                    }
                return sum * 2 * half / across;
            };
            const auto exact = [&](V2d v) { return polygon_density(corners, iris.area_mm2(), v); };
            const auto ours = [&](V2d v) { return double(pattern.density(V2f(v))); };
            const V2d edge = corners[1] - corners[0];
            const double normal = std::atan2(edge.y, edge.x) - kTau / 4, half = kTau / spikes / 4;
            const double spike = light(normal, half, exact);
            EXPECT_NEAR(light(normal, half, ours) / spike, 1, 0.05) << blades << ' ' << periods;
            const double between = light(normal + kTau / spikes / 2, half / 2, exact);
            EXPECT_NEAR(light(normal + kTau / spikes / 2, half / 2, ours) / between, 1, 0.25)
                << blades << ' ' << periods;
            EXPECT_GT(spike, 5 * between);
        }
    }
}

TEST(Diffraction, ContrastOfARoundPupilIsThatOfAnIdealLens) {
    const DiffractingPupil pupil = diffracting_pupil(iris_of(Disk{}));
    for (double s = 0.05; s < 1; s += 0.1) {
        const double ideal = 2 / std::numbers::pi * (std::acos(s) - s * std::sqrt(1 - s * s));
        for (const V2d& along : {V2d(1, 0), V2d(0.6, -0.8)})
            EXPECT_NEAR(contrast(pupil, along * (2 * kPupil_mm * s)), ideal, 0.005) << s;
    }
    EXPECT_EQ(contrast(pupil, V2d(5 * kPupil_mm, 0)), 0);
}

// Draws towards a disc: as dense as they say, and dense where the pattern is.
TEST(Diffraction, StarDrawsFollowTheirDensity) {
    const DiffractionPattern pattern = pattern_of(regular_polygon(5, 0));
    const double r0 = 100 / (2 * kPupil_mm);
    for (const double off : {0., 0.01, 0.03, 0.3}) {
        const double angle = -kTau / 4 + off;  // an edge lies level below
        const V2f middle(V2d(std::cos(angle), std::sin(angle)) * r0);
        const float radius = float(0.02 * r0);
        const auto found = StarAim::at(pattern.far(), middle, radius);
        ASSERT_TRUE(found);
        const StarAim& aim = *found;
        double ones = 0, light = 0, squares = 0;
        constexpr uint32_t count = 1 << 15;
        for (uint32_t i = 0; i < count; ++i) {
            const V2f v =
                aim.draw(Sampler(SamplerKind::Owen, 3, {0, 0, i}).get2(Dim::Diffraction, 1));
            EXPECT_LE((v - middle).length(), 1.001f * radius);
            const double density = double(aim.density(v));
            ASSERT_GT(density, 0);
            ones += 1 / density / count;
            const double value = double(pattern.density(v)) / density;
            light += value / count, squares += value * value / count;
        }
        EXPECT_NEAR(ones / (std::numbers::pi * sqr(radius)), 1, 0.02) << off;
        EXPECT_NEAR(light / double(pattern.far_share() * aim.share()), 1, 0.3) << off;
        EXPECT_LT(squares / (light * light) - 1, 0.3) << off;
    }
}

}  // namespace
}  // namespace petzval::camera
