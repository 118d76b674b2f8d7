// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/pupil_function.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "camera/waves/pupil_rays.h"

namespace petzval {
namespace {

constexpr double kOutside = -1e9;

// Visible part of a bundle: what a lattice of its pupil points says.
struct VisiblePart {
    std::array<double, 2> least{INFINITY, INFINITY}, most{-INFINITY, -INFINITY};  ///< of p, q
    std::array<double, 2> reach_mm{};  ///< of rays from the image point, on the film
    double slopes = 0;                 ///< width of their slopes
};

// Calls a function with each ray that passes the stop and all rims, or only just does not.
template <class Use>
void for_visible(const AimedBundle& bundle, const ReferenceSphere& sphere, const Use& use) {
    constexpr int side = 48;
    constexpr double beyond = 0.1;  // of the squared radius: about a cell of the lattice
    const auto points = bundle.grid(side);
    for (size_t i = 0; i < points.size(); i += 4) {
        d4 s{}, t{};
        for (size_t k = 0; k < 4; ++k) s[k] = points[i + k][0], t[k] = points[i + k][1];
        const auto rays = meet_reference<d4>(bundle, sphere, s, t);
        for (int k = 0; k < 4; ++k)
            if (rays.passed[k] && rays.inside[k] > -beyond &&
                square(rays.stop_x[k]) + square(rays.stop_y[k]) < 1 + beyond)
                use(rays, k);
    }
}

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

// Mean of an iris over each cell, by points that neighbours' places in the stop say.
void apply_iris(PupilFunction& pupil, const StopTransmission& iris, double radius_mm) {
    constexpr int points = 6;
    const auto side = static_cast<size_t>(pupil.grid.side);
    const auto& stop = pupil.stop;
    for (size_t cell = 0; cell < stop.size(); ++cell) {
        if (!(pupil.amplitude[cell] > 0)) continue;
        const auto by = [&](size_t step, bool first, bool last) {
            const size_t a = first ? cell : cell - step, b = last ? cell : cell + step;
            const double over = first || last ? 1 : 2;
            return std::array{(stop[b][0] - stop[a][0]) / over, (stop[b][1] - stop[a][1]) / over};
        };
        const size_t column = cell % side, row = cell / side;
        const auto by_p = by(1, column == 0, column + 1 == side);
        const auto by_q = by(side, row == 0, row + 1 == side);
        double amplitude = 0, light = 0;
        for (int i = 0; i < points; ++i)
            for (int j = 0; j < points; ++j) {
                const double u = (i + 0.5) / points - 0.5, v = (j + 0.5) / points - 0.5;
                const double passed = iris(radius_mm * (stop[cell][0] + u * by_p[0] + v * by_q[0]),
                                           radius_mm * (stop[cell][1] + u * by_p[1] + v * by_q[1]));
                light += passed;
                amplitude += std::sqrt(passed);
            }
        pupil.amplitude[cell] *= amplitude / (points * points);
        pupil.light[cell] *= light / (points * points);
    }
}

}  // namespace

std::optional<PupilGrid> pupil_grid(const AimedBundle& bundle, const ReferenceSphere& sphere,
                                    int least, double depth_mm) {
    // Cells that a wave's slope may turn by half a wavelength, of which this share is used.
    constexpr double used = 0.9, margin = 0.03;
    VisiblePart seen;
    for_visible(bundle, sphere, [&](const auto& rays, int k) {
        const std::array at{rays.p[k], rays.q[k]};
        for (size_t i = 0; i < 2; ++i) {
            seen.least[i] = std::min(seen.least[i], at[i]);
            seen.most[i] = std::max(seen.most[i], at[i]);
        }
    });
    for (const BundleRay& ray : bundle.trace(bundle.grid(48), sphere.film_mm))
        for (size_t i = 0; i < 2; ++i)
            seen.reach_mm[i] =
                std::max(seen.reach_mm[i], std::fabs(ray.film_mm[i] - sphere.image_mm[i]));
    constexpr double parallel = 1e-9;
    const double width = std::max(seen.most[0] - seen.least[0], seen.most[1] - seen.least[1]);
    if (!(width > parallel)) return std::nullopt;
    const double reach_mm =
        std::max(seen.reach_mm[0], seen.reach_mm[1]) + std::fabs(depth_mm) * width;
    PupilGrid out;
    const double across = width * (1 + 2 * margin);
    out.needed = across * 2 * reach_mm / (used * bundle.nm() * 1e-6);
    const double side = std::clamp(out.needed, double(least), double(kMostPupilSide));
    out.side = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(side))));
    out.step = across / out.side;
    for (size_t i = 0; i < 2; ++i)
        out.first[i] = (seen.least[i] + seen.most[i] - across + out.step) / 2;
    return out;
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

}  // namespace petzval
