// SPDX-License-Identifier: Apache-2.0
#include "camera/pupil.h"

#include <algorithm>
#include <cmath>

#include "core/dispersion.h"

namespace petzval {
namespace {

constexpr float kTolerance = 1e-4f;  // of the stop's radius
constexpr int kMostSteps = 12, kMostHalvings = 6;
constexpr int kStopSide = 9;

V2f turned(V2f p, V2f cosine_sine) {
    return {p.x * cosine_sine.x - p.y * cosine_sine.y, p.x * cosine_sine.y + p.y * cosine_sine.x};
}

bool of_revolution(const Lens& lens) {
    const auto& surfaces = lens.prescription().surfaces;
    return std::all_of(surfaces.begin(), surfaces.end(),
                       [](const auto& s) { return s.profile == Profile::Rotational; });
}

}  // namespace

Pupil::Pupil(const Lens& lens, double film_mm, double film_reach_mm)
    : lens_(lens),
      film_mm_(film_mm),
      film_reach_mm_(static_cast<float>(film_reach_mm)),
      stop_radius_mm_(static_cast<float>(
          lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm)),
      symmetric_(of_revolution(lens)),
      columns_(symmetric_ ? 1 : 6),
      rows_(symmetric_ ? 12 : 6),
      table_(static_cast<size_t>(columns_) * rows_ * kStopSide * kStopSide) {
    solve_table();
}

StopCrossing Pupil::cross(V2f film_point_mm, V2f cosines, const LensIndices<f4>& indices) const {
    using D = Dual<f4>;
    const D l{splat(cosines.x), splat(1.f), f4{}}, m{splat(cosines.y), f4{}, splat(1.f)};
    LensRay<D> ray;
    ray.counted_from = lens_.last();
    const auto z = static_cast<float>(film_mm_ - lens_.vertex_mm(lens_.last()));
    ray.origin = {D{splat(film_point_mm.x)}, D{splat(film_point_mm.y)}, D{splat(z)}};
    ray.direction = {l, m, -sqrt(1 - l * l - m * m)};
    StopCrossing out;
    out.clear = m4{-1, -1, -1, -1};
    const auto& facts = lens_.surfaces<float>();
    const auto clip = [&](const LensHit<D>& hit) {
        const f4 x = hit.point.x.value, y = hit.point.y.value;
        out.clear &= x * x + y * y <= facts[static_cast<size_t>(hit.surface)].semi_diameter2_mm2;
    };
    static_cast<void>(march<D>(lens_, indices, Towards::Scene, {lens_.stop(), lens_.last()}, ray,
                               Clip::No, clip));
    out.ray.origin = value_of(ray.origin);
    out.ray.direction = value_of(ray.direction);
    out.ray.counted_from = ray.counted_from;
    out.ray.fate_code = ray.fate_code;
    out.ray.end_surface = ray.end_surface;
    out.x_mm = ray.origin.x.value;
    out.y_mm = ray.origin.y.value;
    out.x_by_l = ray.origin.x.du;
    out.y_by_l = ray.origin.y.du;
    out.x_by_m = ray.origin.x.dv;
    out.y_by_m = ray.origin.y.dv;
    return out;
}

std::optional<V2f> Pupil::newton(V2f film_point_mm, V2f stop_point_mm, V2f cosines,
                                 const LensIndices<f4>& indices, int lane) const {
    V2f good = cosines, step(0.f);
    int halvings = 0;
    for (int i = 0; i < kMostSteps; ++i) {
        const StopCrossing c = cross(film_point_mm, cosines, indices);
        const bool inside = cosines.dot(cosines) < 1.f && c.ray.alive()[lane];
        if (!inside) {  // too far: rays there never reach the stop
            if (++halvings > kMostHalvings) return std::nullopt;
            step *= 0.5f;
            cosines = good + step;
            continue;
        }
        const V2f off(stop_point_mm.x - c.x_mm[lane], stop_point_mm.y - c.y_mm[lane]);
        if (off.length2() < sqr(kTolerance * stop_radius_mm_)) return cosines;
        const float a = c.x_by_l[lane], b = c.x_by_m[lane], d = c.y_by_l[lane], e = c.y_by_m[lane];
        const float determinant = a * e - b * d;
        if (!(std::fabs(determinant) > 0.f)) return std::nullopt;
        good = cosines;
        step = V2f(e * off.x - b * off.y, a * off.y - d * off.x) / determinant;
        cosines = good + step;
    }
    return std::nullopt;
}

V2f Pupil::film_point(int column, int row) const {
    const float step = film_reach_mm_ / static_cast<float>(rows_ - 1);
    return {static_cast<float>(column) * step, static_cast<float>(row) * step};
}

V2f Pupil::stop_point(int i, int j) const {
    const float step = 2 * stop_radius_mm_ / (kStopSide - 1);
    return {static_cast<float>(i) * step - stop_radius_mm_,
            static_cast<float>(j) * step - stop_radius_mm_};
}

Pupil::Known& Pupil::known(int column, int row, int i, int j) {
    return table_[static_cast<size_t>(((column * rows_ + row) * kStopSide + i) * kStopSide + j)];
}

// Each ray from one that is known next to it, outwards from the axis: first the ray to the middle
// of the stop from the film point before, then to the stop's rim.
void Pupil::solve_table() {
    const LensIndices<f4> indices = lens_.exact_indices(splat(static_cast<float>(kLineD_nm)));
    constexpr int middle = kStopSide / 2;
    std::vector<std::array<int, 2>> order;
    for (int i = 0; i < kStopSide; ++i)
        for (int j = 0; j < kStopSide; ++j) order.push_back({i, j});
    const auto away = [](const std::array<int, 2>& p) {
        return std::max(std::abs(p[0] - middle), std::abs(p[1] - middle));
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const auto& a, const auto& b) { return away(a) < away(b); });
    const auto towards_middle = [](int i) { return i + (i < middle) - (i > middle); };
    for (int column = 0; column < columns_; ++column) {
        for (int row = 0; row < rows_; ++row) {
            for (const auto& [i, j] : order) {
                V2f guess(0.f);
                const Known* before = nullptr;
                if (row > 0 || column > 0)
                    before = &known(row > 0 ? column : column - 1, row > 0 ? row - 1 : 0, i, j);
                const Known* inner = nullptr;
                if (i != middle || j != middle)
                    inner = &known(column, row, towards_middle(i), towards_middle(j));
                if (inner && inner->there)
                    guess = inner->cosines;
                else if (before && before->there)
                    guess = before->cosines;
                if (const auto solved =
                        newton(film_point(column, row), stop_point(i, j), guess, indices, 0))
                    known(column, row, i, j) = {*solved, true};
            }
        }
    }
}

// Linear between the solved rays about the two points; the nearest of them where one is missing.
std::optional<V2f> Pupil::between(V2f film_point_mm, V2f stop_point_mm) const {
    const auto place = [](float at, int size) {
        const float inside = std::clamp(at, 0.f, static_cast<float>(size - 1));
        const int cell = std::min(static_cast<int>(inside), std::max(size - 2, 0));
        return std::pair(cell, inside - static_cast<float>(cell));
    };
    const float film_scale = static_cast<float>(rows_ - 1) / film_reach_mm_;
    const float stop_scale = (kStopSide - 1) / (2 * stop_radius_mm_);
    const auto [column, s] = place(film_point_mm.x * film_scale, columns_);
    const auto [row, t] = place(film_point_mm.y * film_scale, rows_);
    const auto [i, u] = place((stop_point_mm.x + stop_radius_mm_) * stop_scale, kStopSide);
    const auto [j, v] = place((stop_point_mm.y + stop_radius_mm_) * stop_scale, kStopSide);
    V2f sum(0.f);
    float there = 0.f;
    for (int k = 0; k < 16; ++k) {
        const bool right = k & 1, up = k & 2, p = k & 4, q = k & 8;
        if (right && columns_ == 1) continue;
        const float weight = (right           ? s
                              : columns_ == 1 ? 1.f
                                              : 1.f - s) *
                             (up ? t : 1.f - t) * (p ? u : 1.f - u) * (q ? v : 1.f - v);
        if (!(weight > 0.f)) continue;
        const Known& corner = known(column + right, row + up, i + p, j + q);
        if (!corner.there) continue;
        sum += corner.cosines * weight;
        there += weight;
    }
    if (!(there > 0.f)) return std::nullopt;
    return sum / there;
}

std::optional<V2f> Pupil::direction(V2f film_point_mm, V2f stop_point_mm,
                                    const LensIndices<f4>& indices, int lane) const {
    // Into the part of the film that the table covers, and back.
    V2f p = film_point_mm, q = stop_point_mm;
    V2f turn(1.f, 0.f), mirror(1.f, 1.f);
    if (symmetric_) {
        const float r = p.length();
        if (r > 0.f) turn = V2f(p.y, p.x) / r;  // takes p to (0, r)
        p = turned(p, turn);
        q = turned(q, turn);
    } else {
        mirror = {p.x < 0.f ? -1.f : 1.f, p.y < 0.f ? -1.f : 1.f};
        p = p * mirror;
        q = q * mirror;
    }
    const auto guess = between(p, q);
    if (!guess) return std::nullopt;
    const V2f back = turned(*guess, V2f(turn.x, -turn.y)) * mirror;
    return newton(film_point_mm, stop_point_mm, back, indices, lane);
}

}  // namespace petzval
