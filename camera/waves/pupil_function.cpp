// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/pupil_function.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "camera/waves/pupil_rays.h"

namespace petzval::camera {
namespace {

constexpr double kOutside = -1e9;

// Margin to the rims: above 0 inside; its change from cell to cell tells the distance in cells.
std::vector<double> coverage(const std::vector<double>& margin, int side) {
    std::vector<double> out(margin.size());
    const auto at = [&](int x, int y) {
        return x < 0 || y < 0 || x >= side || y >= side
                   ? kOutside
                   : margin[size_t(y) * size_t(side) + size_t(x)];
    };
    // Change along one axis, from neighbours that have rays.
    const auto change = [](double before, double here, double after) {
        if (before > kOutside && after > kOutside) return (after - before) / 2;
        return after > kOutside ? after - here : before > kOutside ? here - before : 0;
    };
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double here = at(x, y);
            if (!(here > kOutside)) continue;
            const double slope = std::hypot(change(at(x - 1, y), here, at(x + 1, y)),
                                            change(at(x, y - 1), here, at(x, y + 1)));
            const double share = slope > 0 ? 0.5 + here / slope : here > 0;
            out[size_t(y) * size_t(side) + size_t(x)] = std::clamp(share, 0., 1.);
        }
    return out;
}

// Mean of an iris over each cell, at points of the stop that the next cells' places tell.
void apply_iris(PupilFunction& pupil, const StopTransmission& iris, double radius_mm) {
    constexpr int points = 6;
    const auto side = static_cast<size_t>(pupil.grid.side);
    for (size_t cell = 0; cell < pupil.stop.size(); ++cell) {
        if (!(pupil.amplitude[cell] > 0)) continue;
        const auto here = pupil.stop[cell], right = pupil.stop[cell + (cell % side + 1 < side)],
                   above = pupil.stop[cell + (cell / side + 1 < side ? side : 0)];
        double amplitude = 0, light = 0;
        for (int i = 0; i < points * points; ++i) {
            const double u = (i % points + 0.5) / points - 0.5,
                         v = (i / points + 0.5) / points - 0.5;
            const auto at = [&](size_t k) {
                return radius_mm * (here[k] + u * (right[k] - here[k]) + v * (above[k] - here[k]));
            };
            const double passed = iris(at(0), at(1)) / (points * points);
            light += passed;
            amplitude += std::sqrt(passed) / points;
        }
        pupil.amplitude[cell] *= amplitude;
        pupil.light[cell] *= light;
    }
}

}  // namespace

PupilGrid PupilGrid::with_side(int cells) const {
    PupilGrid out{.step = step * side / cells, .side = cells, .needed = needed};
    for (size_t k = 0; k < 2; ++k) out.first[k] = first[k] + (out.step - step) / 2;
    return out;
}

std::optional<PupilGrid> pupil_grid(const AimedBundle& bundle, const ReferenceSphere& sphere,
                                    double depth_mm) {
    // used: of the slope at which neighbours differ by half a wavelength. beyond: rays that only
    // just do not pass, by about a cell of the lattice.
    constexpr int lattice = 48;
    constexpr double used = 0.9, margin = 0.08, beyond = 0.1, parallel = 1e-9;
    std::array<double, 2> least{INFINITY, INFINITY}, most{-INFINITY, -INFINITY};
    double reach_mm = 0;
    const auto points = bundle.grid(lattice);
    for (size_t i = 0; i < points.size(); i += 4) {
        d4 s{}, t{};
        for (size_t k = 0; k < 4; ++k) s[k] = points[i + k][0], t[k] = points[i + k][1];
        const auto rays = meet_reference<d4>(bundle, sphere, s, t);
        for (int k = 0; k < 4; ++k) {
            if (!rays.passed[k] || !(rays.inside[k] > -beyond) ||
                !(square(rays.stop_x[k]) + square(rays.stop_y[k]) < 1 + beyond))
                continue;
            const std::array at{rays.p[k], rays.q[k]};
            for (size_t j = 0; j < 2; ++j) {
                least[j] = std::min(least[j], at[j]);
                most[j] = std::max(most[j], at[j]);
            }
        }
    }
    for (const BundleRay& ray : bundle.trace(points, sphere.film_mm))
        for (size_t k = 0; k < 2; ++k)
            reach_mm = std::max(reach_mm, std::fabs(ray.film_mm[k] - sphere.image_mm[k]));
    const double width = std::max(most[0] - least[0], most[1] - least[1]);
    if (!(width > parallel)) return std::nullopt;
    const double across = width * (1 + 2 * margin);
    const double needed =
        across * 2 * (reach_mm + std::fabs(depth_mm) * width) / (used * bundle.nm() * 1e-6);
    const double side = std::clamp(needed, double(kImagePupilSide), double(kMostPupilSide));
    PupilGrid whole{.step = across, .side = 1, .needed = needed};
    for (size_t k = 0; k < 2; ++k) whole.first[k] = (least[k] + most[k]) / 2;
    return whole.with_side(static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(side)))));
}

PupilFunction pupil_function(const AimedBundle& bundle, const ReferenceSphere& sphere,
                             const PupilGrid& grid, const StopTransmission& iris) {
    const size_t cells = size_t(grid.side) * size_t(grid.side);
    PupilFunction out{.nm = bundle.nm(), .sphere = sphere, .grid = grid};
    out.amplitude.assign(cells, 0);
    out.light.assign(cells, 0);
    out.opd_mm.assign(cells, 0);
    out.stop.assign(cells, {});
    std::vector<double> margin(cells, kOutside);
    find_pupil_rays(bundle, sphere, grid, [&](size_t cell, const PupilRay& ray) {
        out.light[cell] = ray.light;
        out.opd_mm[cell] = ray.opd_mm;
        out.stop[cell] = ray.stop;
        const double in_stop = 1 - square(ray.stop[0]) - square(ray.stop[1]);
        margin[cell] = std::min(ray.inside, in_stop);
    });
    const auto share = coverage(margin, grid.side);
    for (size_t cell = 0; cell < cells; ++cell) {
        out.amplitude[cell] = share[cell] * std::sqrt(out.light[cell]);
        out.light[cell] *= share[cell];
    }
    const Lens& lens = bundle.lens();
    if (iris)
        apply_iris(out, iris, lens.prescription().surfaces[size_t(lens.stop())].semi_diameter_mm);
    return out;
}

PupilFunction moved(PupilFunction pupil, double shift_mm) {
    const double n2 = square(pupil.sphere.index);
    const auto forward = [&](const std::array<double, 2>& at) {
        return std::sqrt(std::max(n2 - square(at[0]) - square(at[1]), 0.));
    };
    double light = 0, slope[2]{};
    for (size_t i = 0; i < pupil.amplitude.size(); ++i) {
        const double share = pupil.light[i];
        if (!(share > 0)) continue;
        const auto at = pupil.cosines(i);
        light += share;
        for (size_t k = 0; k < 2; ++k) slope[k] += share * at[k] / forward(at);
    }
    if (!(light > 0)) return pupil;
    for (size_t k = 0; k < 2; ++k) {
        slope[k] /= light;
        pupil.sphere.image_mm[k] += shift_mm * slope[k];
    }
    pupil.sphere.film_mm += shift_mm;
    for (size_t i = 0; i < pupil.opd_mm.size(); ++i) {
        const auto at = pupil.cosines(i);
        pupil.opd_mm[i] -= shift_mm * (forward(at) + at[0] * slope[0] + at[1] * slope[1]);
    }
    return pupil;
}

}  // namespace petzval::camera
