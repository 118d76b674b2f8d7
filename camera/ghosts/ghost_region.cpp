// SPDX-License-Identifier: Apache-2.0
#include "camera/ghosts/ghost_region.h"

#include <algorithm>
#include <array>
#include <utility>

namespace petzval::camera {
namespace {

/// Beyond what the rays show, as a share of it: film points, and errors of straight lines; and so
/// many times that where few points of a region see the disc.
constexpr double kFilmMargin = 0.25, kErrorMargin = 0.5, kMarginsWhereBent = 2;
constexpr size_t kUnknowns = 6;

/// Least squares for both coordinates of the point on the last surface, by the film point, the
/// point of the disc and the wavelength.
class StraightFit {
  public:
    explicit StraightFit(const std::vector<GhostRecord>& records) {
        for (const GhostRecord& r : records) film_ += r.film_mm / double(records.size());
        std::array<std::array<double, kUnknowns + 2>, kUnknowns> m{};
        for (const GhostRecord& r : records) {
            const auto a = terms(r);
            for (size_t i = 0; i < kUnknowns; ++i) {
                for (size_t j = 0; j < kUnknowns; ++j) m[i][j] += a[i] * a[j];
                m[i][kUnknowns] += a[i] * r.rear_mm.x;
                m[i][kUnknowns + 1] += a[i] * r.rear_mm.y;
            }
        }
        // What the rays do not tell apart counts as no change.
        for (size_t i = 1; i < kUnknowns; ++i) m[i][i] += 1e-9 * (m[0][0] + m[i][i]);
        for (size_t i = 0; i < kUnknowns; ++i) {
            for (size_t j = 0; j < kUnknowns; ++j) {
                if (j == i) continue;
                const double by = m[j][i] / m[i][i];
                for (size_t k = i; k < kUnknowns + 2; ++k) m[j][k] -= by * m[i][k];
            }
        }
        for (size_t i = 0; i < kUnknowns; ++i)
            by_[i] = V2d(m[i][kUnknowns], m[i][kUnknowns + 1]) / m[i][i];
    }
    [[nodiscard]] V2d film_mm() const { return film_; }
    [[nodiscard]] V2d rear_mm() const { return by_[0]; }
    [[nodiscard]] V2d by_film_x() const { return by_[1]; }
    [[nodiscard]] V2d by_film_y() const { return by_[2]; }
    [[nodiscard]] V2d by_disc_x() const { return by_[3]; }
    [[nodiscard]] V2d by_disc_y() const { return by_[4]; }
    [[nodiscard]] V2d by_wave() const { return by_[5]; }
    [[nodiscard]] V2d error(const GhostRecord& r) const {
        V2d out = r.rear_mm;
        const auto a = terms(r);
        for (size_t i = 0; i < kUnknowns; ++i) out -= by_[i] * a[i];
        return out;
    }

  private:
    [[nodiscard]] std::array<double, kUnknowns> terms(const GhostRecord& r) const {
        const V2d film = r.film_mm - film_;
        return {1, film.x, film.y, r.in_disc.x, r.in_disc.y, r.wave};
    }

    V2d film_{0.};
    std::array<V2d, kUnknowns> by_{};
};

/// Long axis of the ellipse into which two vectors make the unit disc, and its half axes.
std::pair<V2d, V2d> ellipse_of(V2d a, V2d b) {
    const double xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
    const double mean = (xx + yy) / 2, apart = std::hypot((xx - yy) / 2, xy);
    const double angle = std::atan2(2 * xy, xx - yy) / 2;
    return {{std::cos(angle), std::sin(angle)},
            {std::sqrt(mean + apart), std::sqrt(std::max(mean - apart, 0.))}};
}

}  // namespace

StraightRegion straight_region(const std::vector<GhostRecord>& records) {
    const StraightFit fit(records);
    auto [axis, half] = ellipse_of(fit.by_disc_x(), fit.by_disc_y());
    const double of_disc = kPi / 4 * half.x * half.y;
    const V2d across(-axis.y, axis.x);
    V2d error(0.), low = records.front().film_mm, high = low;
    double open = 0;
    for (const GhostRecord& r : records) {
        const V2d e = fit.error(r);
        error.x = std::max(error.x, std::fabs(e.dot(axis)));
        error.y = std::max(error.y, std::fabs(e.dot(across)));
        low = {std::min(low.x, r.film_mm.x), std::min(low.y, r.film_mm.y)};
        high = {std::max(high.x, r.film_mm.x), std::max(high.y, r.film_mm.y)};
        open += r.light_mm2 > 0;
    }
    constexpr double kLeast_mm = 1e-4;  // what floats err
    half += error * (1 + kErrorMargin) + V2d(kLeast_mm);
    StraightRegion found{{}, of_disc / (half.x * half.y), open / double(records.size())};
    const double times = found.sees < kSeesEnough ? kMarginsWhereBent : 1;
    half += error * kErrorMargin * (times - 1);
    const V2d margin = (high - low) * (kFilmMargin * times) + V2d(kLeast_mm);
    GhostRegion& out = found.region;
    out.film_low = V2f(low - margin), out.film_high = V2f(high + margin);
    out.film = V2f(fit.film_mm()), out.rear = V2f(fit.rear_mm());
    out.by_x = V2f(fit.by_film_x()), out.by_y = V2f(fit.by_film_y());
    out.by_wave = V2f(fit.by_wave());
    out.long_axis = V2f(axis), out.half = V2f(half);
    return found;
}

}  // namespace petzval::camera
