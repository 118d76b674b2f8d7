// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/ray_aiming.h"

#include <algorithm>
#include <cmath>

#include "camera/lens/direction_search.h"
#include "camera/lens/trace.h"

namespace petzval::camera {
namespace {

// Tolerances in radii of the stop; Newton's next step squares the latter.
constexpr float kTolerance = 1e-4f, kToleranceBeforeStep = 3e-3f;
// Largest Newton step left, in direction cosines. Where the pupil folds, directions far apart meet
// the stop at nearly one point: a ray that is near it there may have any stretch, and with it any
// weight.
constexpr float kMostStepLeft = 1e-3f;
// Newton step that floats hardly resolve: the rays to a stop far smaller than the lens come no
// nearer.
constexpr float kLeastStep = 1e-6f;
constexpr int kMostSteps = 12;

// Wavelengths at which the table is solved: evenly in 1 / nm, over what is visible.
constexpr f4 kNodes_nm = {400, 466.6667f, 560, 700};

V2f turned(V2f p, V2f cosine_sine) {
    return {p.x * cosine_sine.x - p.y * cosine_sine.y, p.x * cosine_sine.y + p.y * cosine_sine.x};
}

// Weights at t of the nodes 0, 1, 2, 3 by Lagrange's cubic.
f4 cubic(float t) {
    const float a = t - 1, b = t - 2, c = t - 3;
    return f4{a * b * c, t * b * c, t * a * c, t * a * b} * f4{-1 / 6.f, 0.5f, -0.5f, 1 / 6.f};
}

// The four nodes about a place, or the only one.
struct Nodes {
    int first, count;
    f4 weight;
};
Nodes nodes_about(float t, int size) {
    if (size == 1) return {0, 1, f4{1, 0, 0, 0}};
    const auto last = static_cast<float>(size - 1);
    t = t > 0.f ? (t < last ? t : last) : 0.f;  // NaN: 0
    const int first = std::clamp(static_cast<int>(t) - 1, 0, size - 4);
    return {first, 4, cubic(t - static_cast<float>(first))};
}

template <class V>
struct Step {
    V l, m, left2_mm2;
};
template <class V>
Step<V> step_towards(const PlanePoint<V>& stop_mm, const AimedRay<V>& c) {
    const V x = stop_mm.x - c.ray.origin.x, y = stop_mm.y - c.ray.origin.y;
    const V by = 1 / c.determinant();
    return {(c.y_by_m * x - c.x_by_m * y) * by, (c.x_by_l * y - c.y_by_l * x) * by, x * x + y * y};
}

}  // namespace

float RayAimer::Axis::at(int i) const {
    return size == 1 ? first : first + (last - first) * static_cast<float>(i) / float(size - 1);
}

RayAimer::RayAimer(const Lens& lens, double film_mm, double film_reach_mm)
    : lens_(lens),
      film_mm_(film_mm),
      stop_radius_mm_(static_cast<float>(
          lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm)),
      symmetric_(lens.of_revolution()) {
    const float reach = static_cast<float>(film_reach_mm), radius = stop_radius_mm_;
    // Table size: so fine that a guess is a solution for nearly all rays, so coarse that a lens is
    // set up in milliseconds (lens_camera_bench).
    columns_ = symmetric_ ? Axis{0, 0, 1} : Axis{0, reach, 6};
    rows_ = {0, reach, symmetric_ ? 12 : 6};
    across_ = symmetric_ ? Axis{0, radius, 8} : Axis{-radius, radius, 13};
    up_ = {-radius, radius, 15};
    solve_table();
}

template <class V>
AimedRay<V> RayAimer::cross(const PlanePoint<V>& film_mm, V l, V m,
                            const LensIndices<V>& indices) const {
    using D = Dual<V>;
    const V one = broadcast<V>(1);
    LensRay<D> ray = leave(film_mm, D{l, one, V{}}, D{m, V{}, one});
    AimedRay<V> out;
    out.l = l;
    out.m = m;
    out.clear = !MaskOf<V>{};
    const auto& facts = lens_.surfaces<ScalarOf<V>>();
    const auto clip = [&](const LensHit<V>& hit) {
        if (hit.surface == lens_.stop()) return;
        const V x = hit.point.x, y = hit.point.y;
        const auto rim2 = facts[static_cast<size_t>(hit.surface)].semi_diameter2_mm2;
        out.clear &= (x * x + y * y <= rim2) | (hit.reached == 0);
    };
    static_cast<void>(trace_lens<D>({lens_, Towards::Scene, {lens_.stop(), lens_.last()}, Clip::No},
                                    indices, ray, clip));
    out.ray = lens_trace::converted<V>(ray);
    out.x_by_l = ray.origin.x.du;
    out.y_by_l = ray.origin.y.du;
    out.x_by_m = ray.origin.x.dv;
    out.y_by_m = ray.origin.y.dv;
    return out;
}
template AimedRay<f4> RayAimer::cross(const PlanePoint<f4>&, f4, f4, const LensIndices<f4>&) const;
template AimedRay<f8> RayAimer::cross(const PlanePoint<f8>&, f8, f8, const LensIndices<f8>&) const;
template AimedRay<d4> RayAimer::cross(const PlanePoint<d4>&, d4, d4, const LensIndices<d4>&) const;

FoundRays RayAimer::newton(const PlanePoint<f8>& film_mm, const PlanePoint<f8>& stop_mm,
                           const PlanePoint<f8>& guess, const LensIndices<f8>& indices) const {
    FoundRays out;
    const FoundDirections found =
        find_directions(~m8{}, guess.x, guess.y, kMostStepLeft, [&](f8 l, f8 m) -> DirectionStep {
            static_cast<AimedRay<f8>&>(out) = cross<f8>(film_mm, l, m, indices);
            const Step<f8> by = step_towards<f8>(stop_mm, out);
            return {by.l, by.m, (l * l + m * m < 1.f) & out.ray.alive(),
                    by.left2_mm2 < sqr(kTolerance * stop_radius_mm_)};
        });
    out.found = found.found;
    out.traces = found.traces;
    return out;
}

// Direction cosines by Newton's method for each lane by itself; a lane that fails keeps the guess.
RayAimer::Node RayAimer::settled(V2f film_point_mm, V2f stop_point_mm, const Node& guess,
                                 const LensIndices<f4>& indices) const {
    const PlanePoint<f4> film_mm(film_point_mm), stop_mm(stop_point_mm);
    f4 l = guess.l(), m = guess.m();
    m4 inside{}, close{};
    for (int i = 0; i < kMostSteps && !all(close); ++i) {
        const AimedRay<f4> c = cross<f4>(film_mm, l, m, indices);
        inside = c.ray.alive() & (l * l + m * m < 1.f);
        const Step<f4> by = step_towards(stop_mm, c);
        close = ~inside | (by.left2_mm2 < sqr(kToleranceBeforeStep * stop_radius_mm_)) |
                (by.l * by.l + by.m * by.m < sqr(kLeastStep));
        l = inside ? l + by.l : guess.l(), m = inside ? m + by.m : guess.m();
    }
    return {inside & close ? l : guess.l(), inside & close ? m : guess.m()};
}

// Solves the table outwards from the middle of the stop. Each ray is guessed from its neighbour
// nearer to the middle, plus the step between the same two at the film point before.
void RayAimer::solve_table() {
    const LensIndices<f4> indices = lens_.exact_indices(kNodes_nm);
    table_.resize(place(columns_.size, 0, 0, 0));
    const int mid_i = symmetric_ ? 0 : across_.size / 2, mid_j = up_.size / 2;
    std::vector<std::array<int, 2>> order;
    for (int i = 0; i < across_.size; ++i)
        for (int j = 0; j < up_.size; ++j) order.push_back({i, j});
    const auto away = [&](const std::array<int, 2>& p) {
        return std::max(std::abs(p[0] - mid_i), std::abs(p[1] - mid_j));
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const auto& a, const auto& b) { return away(a) < away(b); });
    const auto towards = [](int i, int middle) { return i + (i < middle) - (i > middle); };
    for (int column = 0; column < columns_.size; ++column)
        for (int row = 0; row < rows_.size; ++row)
            for (const auto& [i, j] : order) {
                const int inner_i = towards(i, mid_i), inner_j = towards(j, mid_j);
                const int before_c = row > 0 ? column : std::max(column - 1, 0);
                const int before_r = std::max(row - 1, 0);
                const Node inner = table_[place(column, row, inner_i, inner_j)];
                const Node before = table_[place(before_c, before_r, i, j)];
                const Node other = table_[place(before_c, before_r, inner_i, inner_j)];
                Node guess = before;
                if (i != mid_i || j != mid_j) guess.lm += inner.lm - other.lm;
                table_[place(column, row, i, j)] =
                    settled({columns_.at(column), rows_.at(row)}, {across_.at(i), up_.at(j)}, guess,
                            indices);
            }
}

V2f RayAimer::between(V2f film_point_mm, V2f stop_point_mm, float nm) const {
    const auto along = [](const Axis& axis, float at) {
        return nodes_about((at - axis.first) * float(axis.size - 1) / (axis.last - axis.first),
                           axis.size);
    };
    const Nodes column = along(columns_, film_point_mm.x), row = along(rows_, film_point_mm.y);
    const Nodes across = along(across_, stop_point_mm.x), up = along(up_, stop_point_mm.y);
    f8 lm{};
    for (int a = 0; a < column.count; ++a)
        for (int b = 0; b < row.count; ++b)
            for (int c = 0; c < 4; ++c) {
                const Node* node =
                    &table_[place(column.first + a, row.first + b, across.first + c, up.first)];
                const f8 line = (node[0].lm * up.weight[0] + node[1].lm * up.weight[1]) +
                                (node[2].lm * up.weight[2] + node[3].lm * up.weight[3]);
                lm += line * (column.weight[a] * row.weight[b] * across.weight[c]);
            }
    const f4 weights =
        cubic(3 * (1 / kNodes_nm[0] - 1 / nm) / (1 / kNodes_nm[0] - 1 / kNodes_nm[3]));
    const f8 weighted = lm * joined(weights, weights);
    return {(weighted[0] + weighted[1]) + (weighted[2] + weighted[3]),
            (weighted[4] + weighted[5]) + (weighted[6] + weighted[7])};
}

// Direction cosines from the table. Symmetry: turn and mirror into the part that it covers, and
// back.
V2f RayAimer::guess(V2f film_point_mm, V2f stop_point_mm, float nm) const {
    V2f p = film_point_mm, q = stop_point_mm;
    V2f turn(1.f, 0.f);
    if (symmetric_) {
        const float r = p.length();
        if (r > 0.f) turn = V2f(p.y, p.x) / r;  // takes p to (0, r)
        p = {0.f, r};
        q = turned(q, turn);
    }
    const V2f mirror((symmetric_ ? q.x : p.x) < 0.f ? -1.f : 1.f, p.y < 0.f ? -1.f : 1.f);
    return turned(between(p * mirror, q * mirror, nm) * mirror, V2f(turn.x, -turn.y));
}

FoundRays RayAimer::aim(const PlanePoint<f8>& film_mm, const PlanePoint<f8>& stop_mm,
                        const LensIndices<f8>& indices, f8 nm) const {
    PlanePoint<f8> cosines(f8{}, f8{});
    for (int i = 0; i < 8; ++i) {
        const V2f lm = guess(film_mm[i], stop_mm[i], nm[i]);
        cosines.x[i] = lm.x, cosines.y[i] = lm.y;
    }
    return newton(film_mm, stop_mm, cosines, indices);
}

}  // namespace petzval::camera
