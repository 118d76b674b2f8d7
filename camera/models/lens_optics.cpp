// SPDX-License-Identifier: Apache-2.0
#include "camera/models/lens_optics.h"

#include <algorithm>

#include "camera/lens/trace.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {
namespace {

template <class V>
constexpr int kLanes = NumberTraits<V>::lanes;

// Four lanes from the first one on.
template <class V>
f4 four(const V& a, int first = 0) {
    f4 out;
    for (int i = 0; i < 4; ++i) out[i] = static_cast<float>(a[first + i]);
    return out;
}

// Transmittance of a surface for the light that was traced to it, of four lanes from the first one.
template <class V>
f4 transmittance_at(const LensPassage& through, const CoatTables& coats,
                    const LensIndices<V>& indices, const LensHit<V>& hit, f4 nm, int first = 0) {
    const auto& s = through.lens.surfaces<ScalarOf<V>>()[static_cast<size_t>(hit.surface)];
    if (s.medium_before == s.medium_after) return splat(1.f);
    const int into = through.to_film() ? s.medium_after : s.medium_before;
    const f4 index_into = four(indices.of_medium[into], first);
    return coats.transmittance(hit.surface,
                               {four(hit.index, first), index_into, four(hit.cosine, first)}, nm);
}

}  // namespace

LensOptics::LensOptics(std::shared_ptr<const Lens> lens, Iris iris, Coating coating, double film_mm,
                       double film_reach_mm)
    : lens_(std::move(lens)),
      iris_(std::move(iris)),
      film_mm_(film_mm),
      stop_rim2_mm2_(lens_->surfaces<float>()[size_t(lens_->stop())].semi_diameter2_mm2),
      aimer_(*lens_, film_mm, film_reach_mm) {
    if (coating != Coating::Ideal) coats_.emplace(*lens_, coating);
    if (!lens_->of_revolution()) return;
    const auto line_d_nm = splat8(static_cast<float>(kLineD_nm));
    const LensIndices<f8> line_d = lens_->exact_indices(line_d_nm);
    const auto passes = [&](float height_mm, f8 x, f8 y) {
        const FoundRays aimed = aimer_.aim(PlanePoint<f8>(V2f(0.f, height_mm)),
                                           PlanePoint<f8>(x, y), line_d, line_d_nm);
        LensRay<f8> ray = aimed.ray;
        return m8(aimed.found & aimed.clear &
                  trace_lens<f8>({*lens_, Towards::Scene, {0, lens_->stop() - 1}, Clip::Yes},
                                 line_d, ray));
    };
    const auto rim_mm = static_cast<float>(
        lens_->prescription().surfaces[static_cast<size_t>(lens_->stop())].semi_diameter_mm);
    // A pixel's filter reaches a little beyond the film.
    constexpr double kBeyondFilm = 1.02;
    bounds_ = StopBoundsByHeight(passes, static_cast<float>(kBeyondFilm * film_reach_mm),
                                 std::min(rim_mm, iris_.bounding_radius_mm()), iris_.area_mm2());
}

PlanePoint<f8> LensOptics::drawn_stop_mm(const LeadPoints& at) const {
    PlanePoint<f8> out(f8{}, f8{});
    for (size_t i = 0; i < 8; ++i) {
        const V2f stop = stop_at(at.film_mm[i]).sample(at.u[i]);
        out.x[i] = stop.x, out.y[i] = stop.y;
    }
    return out;
}

LeadRays LensOptics::aim(const LeadPoints& at, const PlanePoint<f8>& stop_mm,
                         const LensIndices<f8>& indices) const {
    LeadRays out;
    PlanePoint<f8> film_mm(f8{}, f8{});
    for (size_t i = 0; i < 8; ++i) film_mm.x[i] = at.film_mm[i].x, film_mm.y[i] = at.film_mm[i].y;
    out.stop_mm = stop_mm;
    out.aimed = aimer_.aim(film_mm, stop_mm, indices, at.nm);
    return out;
}

// The solver's residual counts for nothing: the ray crosses the iris where it was drawn, as an iris
// may be smaller than the tolerance.
void LensOptics::trace(const LeadPoints& at, const LensIndices<f8>& indices, LeadRays& rays) const {
    for (int i = 0; i < 8; ++i) {
        rays.open[i] = transmits(rays.stop_mm[i]);
        rays.density[i] =
            stop_at(at.film_mm[static_cast<size_t>(i)]).density(rays.stop_mm[i], rays.open[i]);
    }
    rays.density *= rays.aimed.stretch_mm2();
    rays.ray = rays.aimed.ray;
    rays.passed = rays.aimed.found & rays.aimed.clear & (rays.open > 0.f) & (rays.density > 0.f);
    if (!any(rays.passed)) return;
    rays.passed &= trace_lens<f8>({*lens_, Towards::Scene, {0, lens_->stop() - 1}, Clip::Yes},
                                  indices, rays.ray);
}

namespace {

// Traces one group of rays, or two side by side. The observer gets the group's index first.
template <class V, size_t groups, class Observer = NoObserver>
void trace_groups(const LensPassage& through, const std::array<LensIndices<V>, groups>& indices,
                  std::array<LensRay<V>, groups>& rays, const Observer& observe = {}) {
    if constexpr (groups == 2)
        trace_two<V>(through, indices, rays, observe);
    else
        static_cast<void>(
            trace_lens<V>(through, indices[0], rays[0], [&](const auto& hit) { observe(0, hit); }));
}

// Four lanes for each of some rays of the scene.
template <class V>
class RayGroup {
    using S = ScalarOf<V>;
    using Drawn = DrawnRay<S>;

  public:
    explicit RayGroup(const Drawn* drawn) : drawn_(drawn) {}

    [[nodiscard]] const Drawn& drawn(int lane) const { return drawn_[lane / 4]; }
    /// A number of each ray, for all its lanes.
    template <class Value>
    [[nodiscard]] V each(const Value& value) const {
        V all;
        for (int i = 0; i < kLanes<V>; ++i) all[i] = static_cast<S>(value(drawn(i)));
        return all;
    }
    /// That of the hero lane, for all lanes of its ray.
    [[nodiscard]] V of_hero(const V& a) const {
        V all;
        for (int i = 0; i < kLanes<V>; ++i) all[i] = a[i / 4 * 4 + drawn(i).hero];
        return all;
    }
    /// The rays, back towards the lens.
    [[nodiscard]] LensRay<V> rays() const {
        LensRay<V> ray;
        ray.counted_from = drawn_[0].ray.counted_from;
        ray.origin = {each([](const Drawn& r) { return r.ray.origin.x; }),
                      each([](const Drawn& r) { return r.ray.origin.y; }),
                      each([](const Drawn& r) { return r.ray.origin.z; })};
        ray.direction = {each([](const Drawn& r) { return -r.ray.direction.x; }),
                         each([](const Drawn& r) { return -r.ray.direction.y; }),
                         each([](const Drawn& r) { return -r.ray.direction.z; })};
        return ray;
    }
    /// Where they meet the stop. What rounding and the solver leave shows in the hero lane,
    /// whose way is known, and is taken off all of them.
    [[nodiscard]] PlanePoint<V> at_stop(const LensRay<V>& ray) const {
        const V x = ray.origin.x, y = ray.origin.y;
        return {x + (each([](const Drawn& r) { return r.stop_mm.x; }) - of_hero(x)),
                y + (each([](const Drawn& r) { return r.stop_mm.y; }) - of_hero(y))};
    }

  private:
    const Drawn* drawn_;
};

}  // namespace

template <class V, size_t groups>
std::array<LensLanding, kRaysAtOnce<V, groups>> LensOptics::land(
    const std::array<DrawnRay<ScalarOf<V>>, kRaysAtOnce<V, groups>>& drawn,
    const std::array<LensIndices<V>, groups>& indices) const {
    using S = ScalarOf<V>;
    constexpr size_t kEach = kLanes<V> / 4;
    std::array<LensLanding, kRaysAtOnce<V, groups>> out;
    for (LensLanding& one : out) one.transmitted = splat(1.f);
    const LensPassage all_surfaces{*lens_, Towards::Film, {0, lens_->last()}, Clip::Yes};
    const auto lose = [&](size_t group, const LensHit<V>& hit) {
        if (!coats_) return;
        for (size_t k = 0; k < kEach; ++k)
            out[group * kEach + k].transmitted *=
                transmittance_at(all_surfaces, *coats_, indices[group], hit,
                                 drawn[group * kEach + k].nm, int(4 * k));
    };
    const auto group_at = [&](size_t k) { return RayGroup<V>(&drawn[k * kEach]); };
    std::array<LensRay<V>, groups> rays;
    for (size_t k = 0; k < groups; ++k) rays[k] = group_at(k).rays();
    const int stop = lens_->stop();
    trace_groups<V>({*lens_, Towards::Film, {0, stop - 1}, Clip::Yes}, indices, rays, lose);
    trace_groups<V>({*lens_, Towards::Film, {stop, stop}, Clip::No}, indices, rays);
    const std::array<LensRay<V>, groups> at_stop = rays;
    trace_groups<V>({*lens_, Towards::Film, {stop + 1, lens_->last()}, Clip::Yes}, indices, rays,
                    lose);
    for (size_t k = 0; k < groups; ++k) {
        const RayGroup<V> group = group_at(k);
        const LensRay<V>& ray = rays[k];
        const PlanePoint<V> stop_mm = group.at_stop(at_stop[k]);
        const MaskOf<V> arrived = ray.alive();
        const V to_film =
            (S(film_mm_ - lens_->vertex_mm(ray.counted_from)) - ray.origin.z) / ray.direction.z;
        const V film_x = ray.origin.x + to_film * ray.direction.x;
        const V film_y = ray.origin.y + to_film * ray.direction.y;
        const V shift_x = film_x - group.of_hero(film_x), shift_y = film_y - group.of_hero(film_y);
        for (int i = 0; i < kLanes<V>; ++i) {
            LensLanding& one = out[k * kEach + size_t(i / 4)];
            const V2f shift(static_cast<float>(shift_x[i]), static_cast<float>(shift_y[i]));
            const float open = arrived[i] ? transmits(stop_mm[i]) : 0.f;
            one.shift_x_mm[i % 4] = shift.x, one.shift_y_mm[i % 4] = shift.y;
            one.open[i % 4] = open;
            one.drawn[i % 4] = stop_at(group.drawn(i).film_mm + shift).density(stop_mm[i], open);
        }
    }
    return out;
}
template std::array<LensLanding, 1> LensOptics::land(const std::array<DrawnRay<float>, 1>&,
                                                     const std::array<LensIndices<f4>, 1>&) const;
template std::array<LensLanding, 1> LensOptics::land(const std::array<DrawnRay<double>, 1>&,
                                                     const std::array<LensIndices<d4>, 1>&) const;
template std::array<LensLanding, 2> LensOptics::land(const std::array<DrawnRay<float>, 2>&,
                                                     const std::array<LensIndices<f8>, 1>&) const;
template std::array<LensLanding, 4> LensOptics::land(const std::array<DrawnRay<float>, 4>&,
                                                     const std::array<LensIndices<f8>, 2>&) const;

template <class V>
f4 LensOptics::transmitted(V2f film_mm, V l, V m, const LensIndices<V>& indices, f4 nm) const {
    f4 out = splat(1.f);
    if (!coats_) return out;
    const LensPassage out_of_lens{*lens_, Towards::Scene, {0, lens_->last()}, Clip::No};
    const auto lose = [&](const LensHit<V>& hit) {
        out *= transmittance_at(out_of_lens, *coats_, indices, hit, nm);
    };
    LensRay<V> ray = aimer_.leave<V>(PlanePoint<V>(film_mm), l, m);
    static_cast<void>(trace_lens<V>(out_of_lens, indices, ray, lose));
    return out;
}
template f4 LensOptics::transmitted(V2f, f4, f4, const LensIndices<f4>&, f4) const;
template f4 LensOptics::transmitted(V2f, d4, d4, const LensIndices<d4>&, f4) const;

}  // namespace petzval::camera
