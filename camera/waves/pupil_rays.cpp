// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/pupil_rays.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval::camera {
namespace {

using D = Dual<d4>;

// Known ray, from which neighbours are guessed: its place and d(pupil point) / d(p, q).
struct Known {
    std::array<double, 2> cosines;
    PupilPoint at;
    double s_by_p, s_by_q, t_by_p, t_by_q;

    [[nodiscard]] PupilPoint guess(double p, double q) const {
        p -= cosines[0];
        q -= cosines[1];
        return {at[0] + s_by_p * p + s_by_q * q, at[1] + t_by_p * p + t_by_q * q};
    }
};

// Rays of four cells, and which of them were found.
struct FourRays {
    d4 s, t;
    ReferenceRay<D> rays{};
    std::array<bool, 4> found{};

    [[nodiscard]] double determinant(int k) const {
        return rays.p.du[k] * rays.q.dv[k] - rays.p.dv[k] * rays.q.du[k];
    }
    [[nodiscard]] Known known(int k) const {
        const double over = 1 / determinant(k);
        return {{rays.p.value[k], rays.q.value[k]},
                {s[k], t[k]},
                rays.q.dv[k] * over,
                -rays.p.dv[k] * over,
                -rays.q.du[k] * over,
                rays.p.du[k] * over};
    }
};

class PupilRayFinder {
  public:
    PupilRayFinder(const AimedBundle& bundle, const ReferenceSphere& sphere, const PupilGrid& grid)
        : bundle_(bundle), sphere_(sphere), grid_(grid) {}

    // Newton's method, lane by lane; a step from which no ray comes back is halved.
    [[nodiscard]] FourRays find(const d4& p, double q, const Known& from) const {
        constexpr int most_steps = 16;
        constexpr double close = 1e-7;  // of a cell
        FourRays out;
        for (int k = 0; k < 4; ++k) {
            const PupilPoint guess = from.guess(p[k], q);
            out.s[k] = guess[0], out.t[k] = guess[1];
        }
        d4 good_s = broadcast<d4>(from.at[0]), good_t = broadcast<d4>(from.at[1]);
        for (int i = 0; i < most_steps; ++i) {
            out.rays = meet(out.s, out.t);
            bool all_found = true;
            for (int k = 0; k < 4; ++k) {
                if (!out.rays.passed[k]) {
                    out.s[k] = (out.s[k] + good_s[k]) / 2, out.t[k] = (out.t[k] + good_t[k]) / 2;
                    out.found[size_t(k)] = all_found = false;
                    continue;
                }
                const double off_p = p[k] - out.rays.p.value[k], off_q = q - out.rays.q.value[k];
                out.found[size_t(k)] = std::hypot(off_p, off_q) <= close * grid_.step;
                if (out.found[size_t(k)]) continue;
                all_found = false;
                const double determinant = out.determinant(k);
                if (!(std::fabs(determinant) > 0)) continue;
                good_s[k] = out.s[k], good_t[k] = out.t[k];
                const PupilPoint next = out.known(k).guess(p[k], q);
                out.s[k] = next[0], out.t[k] = next[1];
            }
            if (all_found) break;
        }
        return out;
    }

    [[nodiscard]] std::optional<Known> chief() const {
        const PupilPoint at = bundle_.chief();
        FourRays out{.s = broadcast<d4>(at[0]), .t = broadcast<d4>(at[1])};
        out.rays = meet(out.s, out.t);
        if (!out.rays.passed[0] || !(std::fabs(out.determinant(0)) > 0)) return std::nullopt;
        return out.known(0);
    }

    // The four cells that begin at a column, which may lie partly beyond the grid.
    [[nodiscard]] FourRays cells(int column, int row, const Known& from) const {
        d4 p{};
        for (int k = 0; k < 4; ++k) p[k] = grid_.first[0] + grid_.step * (column + k);
        return find(p, grid_.first[1] + grid_.step * row, from);
    }
    // Cell of the grid that is nearest to a ray.
    [[nodiscard]] int nearest(double cosine, size_t axis) const {
        const double at = std::round((cosine - grid_.first[axis]) / grid_.step);
        return static_cast<int>(std::clamp(at, 0., double(grid_.side - 1)));
    }

  private:
    [[nodiscard]] ReferenceRay<D> meet(const d4& s, const d4& t) const {
        return meet_reference<D>(bundle_, sphere_, {s, broadcast<d4>(1), d4{}},
                                 {t, d4{}, broadcast<d4>(1)});
    }

    const AimedBundle& bundle_;
    const ReferenceSphere& sphere_;
    const PupilGrid& grid_;
};

}  // namespace

void find_pupil_rays(const AimedBundle& bundle, const ReferenceSphere& sphere,
                     const PupilGrid& grid,
                     const std::function<void(size_t, const PupilRay&)>& tell) {
    const PupilRayFinder finder(bundle, sphere, grid);
    const auto chief = finder.chief();
    if (!chief) return;
    const int groups = grid.side / 4, middle_group = finder.nearest(chief->cosines[0], 0) / 4,
              middle_row = finder.nearest(chief->cosines[1], 1);
    // Returns whether the row may go on: not where it leads away from the stop.
    double last_r2 = 0;
    const auto group = [&](int number, int row, Known& from, bool rightwards) {
        constexpr double far = 1.5;  // square of the stop's radius
        const FourRays four = finder.cells(4 * number, row, from);
        double r2 = INFINITY;
        for (int k = 0; k < 4; ++k) {
            if (!four.found[size_t(k)]) continue;
            const std::array stop{four.rays.stop_x[k], four.rays.stop_y[k]};
            r2 = std::min(r2, square(stop[0]) + square(stop[1]));
            const double light = 1 / std::fabs(four.determinant(k));
            // Glasses without an index have no path.
            if (std::isfinite(light) && std::isfinite(four.rays.opd_mm[k]))
                tell(size_t(row) * size_t(grid.side) + size_t(4 * number + k),
                     {light, four.rays.opd_mm[k], stop, four.rays.inside[k]});
        }
        for (int k = 0; k < 4; ++k)
            if (const int last = rightwards ? k : 3 - k; four.found[size_t(last)])
                from = four.known(last);
        const bool leads_away = r2 > far && r2 >= last_r2;
        last_r2 = r2;
        return !leads_away;
    };
    for (const int up : {1, -1}) {
        Known row_start = *chief;
        for (int row = up > 0 ? middle_row : middle_row - 1; row >= 0 && row < grid.side;
             row += up) {
            Known from = row_start;
            group(middle_group, row, from, true);
            row_start = from;
            const double middle_r2 = last_r2;
            for (int i = middle_group + 1; i < groups && group(i, row, from, true);) ++i;
            from = row_start;
            last_r2 = middle_r2;
            for (int i = middle_group - 1; i >= 0 && group(i, row, from, false);) --i;
        }
    }
}

}  // namespace petzval::camera
