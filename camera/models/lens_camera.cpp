// SPDX-License-Identifier: Apache-2.0
#include "camera/models/lens_camera.h"

#include <algorithm>
#include <cmath>

#include "camera/dispersion/strategies.h"
#include "camera/lens/trace.h"
#include "core/spectrum/glass.h"

namespace petzval::camera {
namespace {

constexpr auto kLineD = static_cast<float>(kLineD_nm);

// Transmission of the stop at a point of each lane.
template <class V>
V stop_transmission(const LensOptics& optics, const PlanePoint<V>& p) {
    V out = broadcast<V>(ScalarOf<V>(optics.transmits(p[0])));
    for (int i = 1; i < 4; ++i)
        if (p.x[i] != p.x[0] || p.y[i] != p.y[0]) out[i] = optics.transmits(p[i]);
    return out;
}

template <class To, class From>
To lanes_as(From a) {
    if constexpr (std::same_as<To, From>)
        return a;
    else
        return __builtin_convertvector(a, To);
}

template <class V>
ScalarOf<V> sum(V a) {
    return (a[0] + a[1]) + (a[2] + a[3]);
}

// Losses of the lanes that are on. A ray that a rim clips first counts as vignetted.
template <class V>
LensLosses<uint32_t> losses(m4 on, const LensDraw<V>& drawn, MaskOf<V> clear) {
    const auto count = [on](MaskOf<V> lanes) {
        return static_cast<uint32_t>(lane_count(on & lanes_as<m4>(lanes)));
    };
    LensLosses<uint32_t> out = drawn.losses;
    const MaskOf<V> lost = !(drawn.weight > 0);
    if (!any(on & lanes_as<m4>(lost))) return out;
    const auto ended = [&](RayStatus status) {
        return count(clear & (drawn.ray.status_code == static_cast<int>(status)));
    };
    out.totally_reflected = ended(RayStatus::TotallyReflected);
    out.missed = ended(RayStatus::Missed);
    out.vignetted = count(lost) - out.totally_reflected - out.missed;
    return out;
}

}  // namespace

f4 LensCamera::Place::coating_nm() const {
    return bands.spectral ? bands.nm : splat(kLineD);
}

LensCamera::LensCamera(LensCameraInput in)
    : in_(std::move(in)),
      pose_(in_.to_world),
      optics_(in_.lens, in_.iris, in_.coating, in_.film_mm,
              0.5 * std::hypot(in_.film_width_mm, in_.film_height_mm)),
      line_d_(in_.lens->exact_indices(splat(kLineD))),
      line_d_of_all_(in_.lens->exact_indices(splat8(kLineD))),
      exact_line_d_(in_.lens->exact_indices(broadcast<d4>(kLineD_nm))) {}

template <class S>
S LensCamera::behind_pupil_mm(const SceneRay<S>& ray) const {
    return static_cast<S>(ray.origin.z + in_.lens->vertex_mm(ray.counted_from) -
                          in_.entrance_pupil_mm);
}

template <class S>
Ray LensCamera::in_world(const SceneRay<S>& ray) const {
    const auto point_m =
        V3f(static_cast<float>(ray.origin.x * S(1e-3)), static_cast<float>(ray.origin.y * S(1e-3)),
            static_cast<float>(behind_pupil_mm(ray) * S(1e-3)));
    const V3f direction(static_cast<float>(ray.direction.x), static_cast<float>(ray.direction.y),
                        static_cast<float>(ray.direction.z));
    Ray out;
    out.origin = pose_.origin + pose_.to_world(point_m);
    out.direction = unit(pose_.to_world(direction));
    return out;
}
template Ray LensCamera::in_world(const SceneRay<float>&) const;

// The image stands on its head.
FilmLanding LensCamera::in_pixels(const LensLanding& at, V2f frame_px) const {
    return {at.shift_x_mm / -static_cast<float>(in_.film_width_mm) * frame_px.x,
            at.shift_y_mm / static_cast<float>(in_.film_height_mm) * frame_px.y, at.open, at.drawn,
            at.transmitted};
}

/// Film point with a ray for each lane.
template <class V>
class LensCamera::Point {
    using S = ScalarOf<V>;

  public:
    /// Camera, place and rays must outlive it; lane: that of the film point among the rays.
    Point(const LensCamera& camera, const Place& place, const LeadRays& rays, int lane)
        : c_(camera), at_(place), hero_(rays), lane_(lane) {
        if (at_.achromatic) return;
        if constexpr (std::same_as<V, d4>)
            own_ = lens().exact_indices(lanes_as<d4>(at_.bands.nm));
        else
            own_ = lens().indices(at_.bands.nm);
    }
    Point(const Point&) = delete;
    Point& operator=(const Point&) = delete;

    [[nodiscard]] LensDraw<V> rays(const LaneRequest&) const;
    [[nodiscard]] Ray ray(const LensDraw<V>& rays, int lane) const {
        return c_.in_world(lane_of(rays.ray, lane));
    }
    [[nodiscard]] float density(const LensDraw<V>& rays) const { return rays.density; }
    [[nodiscard]] FilmLanding landing(const LensDraw<V>&, const LaneRequest&) const;
    [[nodiscard]] float exposure() const { return c_.exposure_; }

  private:
    [[nodiscard]] const Lens& lens() const { return *c_.in_.lens; }
    [[nodiscard]] const LensIndices<V>& indices() const {
        if (!at_.achromatic) return own_;
        if constexpr (std::same_as<V, d4>)
            return c_.exact_line_d_;
        else
            return c_.line_d_;
    }

    const LensCamera& c_;
    const Place& at_;
    const LeadRays& hero_;
    int lane_;
    LensIndices<V> own_;
};

// Weights of a draw. Irradiance is the integral of radiance dL dM, L and M the direction cosines at
// the film: the cosine is in it. A point drawn on the stop and solved for one lane has its density
// times stretch in (L, M); other lanes might have drawn the same direction, and all are weighed
// with the mean density (balance heuristic: Veach 1997, 9.2.3), so that light at the iris's
// edge is not lost where its image differs between wavelengths.
template <class V>
LensDraw<V> LensCamera::Point<V>::rays(const LaneRequest& request) const {
    LensDraw<V> out;
    out.losses.drawn = static_cast<uint32_t>(lane_count(request.lanes));
    if (!hero_.aimed.found[lane_]) {
        out.losses.unreached = out.losses.drawn;
        return out;
    }
    const AimedRay<V> aimed =
        c_.optics_.aimer().cross(PlanePoint<V>(at_.film_mm), broadcast<V>(S(hero_.aimed.l[lane_])),
                                 broadcast<V>(S(hero_.aimed.m[lane_])), indices());
    // The solver's residual is taken off, so that the lane crosses the iris where it was drawn: an
    // iris may be smaller than the tolerance.
    const PlanePoint<V> at_stop(
        aimed.ray.origin.x + (S(at_.stop_mm.x) - aimed.ray.origin.x[request.hero]),
        aimed.ray.origin.y + (S(at_.stop_mm.y) - aimed.ray.origin.y[request.hero]));
    const MaskOf<V> there = lanes_as<MaskOf<V>>(request.lanes) & aimed.ray.alive();
    const V open = select(there, stop_transmission(c_.optics_, at_stop), V{});
    const auto lanes = static_cast<S>(out.losses.drawn);
    // Also of lanes for which the iris is shut there: bounds overhang it.
    const StopDraw draw = c_.optics_.stop_at(at_.film_mm);
    V of_point{};
    for (int i = 0; i < 4; ++i)
        if (there[i]) of_point[i] = draw.density(at_stop[i], static_cast<float>(open[i]));
    const S density = sum<V>(of_point * aimed.stretch_mm2()) / lanes;
    out.ray = aimed.ray;
    if (density > 0 && any(aimed.clear & (open > 0))) {
        static_cast<void>(trace_lens<V>({lens(), Towards::Scene, {0, lens().stop() - 1}, Clip::Yes},
                                        indices(), out.ray));
        const S gain = S(c_.gain_) * static_cast<S>(lane_count(at_.bands.on)) / lanes;
        out.weight = select(aimed.clear & out.ray.alive(), V(open * (gain / density)), V{});
        out.density = static_cast<float>(density);
    }
    out.losses = losses(request.lanes, out, aimed.clear);
    if (request.coated && any(out.weight > 0))
        out.weight *= lanes_as<V>(
            c_.optics_.transmitted(at_.film_mm, aimed.l, aimed.m, indices(), at_.coating_nm()));
    return out;
}

template <class V>
FilmLanding LensCamera::Point<V>::landing(const LensDraw<V>& rays,
                                          const LaneRequest& request) const {
    const std::array landed = c_.optics_.template land<V, 1>(
        std::array{DrawnRay<S>{lane_of(rays.ray, request.hero), request.hero, at_.film_mm,
                               at_.stop_mm, at_.bands.nm}},
        std::array{indices()});
    return c_.in_pixels(landed[0], at_.frame_px);
}

/// Film point with the ray of the hero lane, and none but that.
class LensCamera::LeadPoint {
  public:
    struct Rays {
        f4 weight{};
        LensLosses<uint32_t> losses;
        [[nodiscard]] f4 weight_of_lanes() const { return weight; }
    };

    /// Camera, place and rays must outlive it; lane: that of the film point among the rays.
    LeadPoint(const LensCamera& camera, const Place& place, const LeadRays& rays, int lane,
              const LensLanding& landing)
        : c_(camera), at_(place), rays_(rays), lane_(lane), landing_(landing) {}

    [[nodiscard]] Rays rays(const LaneRequest&) const;
    [[nodiscard]] Ray ray(const Rays&, int) const { return c_.in_world(lane_of(rays_.ray, lane_)); }
    [[nodiscard]] float density(const Rays&) const { return rays_.density[lane_]; }
    [[nodiscard]] FilmLanding landing(const Rays&, const LaneRequest&) const {
        return c_.in_pixels(landing_, at_.frame_px);
    }
    [[nodiscard]] float exposure() const { return c_.exposure_; }

  private:
    [[nodiscard]] LensLosses<uint32_t> losses(uint32_t lanes) const;

    const LensCamera& c_;
    const Place& at_;
    const LeadRays& rays_;
    int lane_;
    const LensLanding& landing_;
};

// As Point::rays(), where one lane's ray is the only one.
LensCamera::LeadPoint::Rays LensCamera::LeadPoint::rays(const LaneRequest& request) const {
    Rays out;
    const int lanes = lane_count(request.lanes);
    out.losses = losses(static_cast<uint32_t>(lanes));
    if (!rays_.passed[lane_]) return out;
    const float gain =
        c_.gain_ * static_cast<float>(lane_count(at_.bands.on)) / static_cast<float>(lanes);
    out.weight = zero_off(request.lanes, splat(rays_.open[lane_] * (gain / rays_.density[lane_])));
    if (request.coated && c_.in_.coating != Coating::Ideal)
        out.weight *= c_.optics_.transmitted(
            at_.film_mm, splat(rays_.aimed.l[lane_]), splat(rays_.aimed.m[lane_]),
            at_.achromatic ? c_.line_d_ : c_.in_.lens->indices(at_.bands.nm), at_.coating_nm());
    return out;
}

LensLosses<uint32_t> LensCamera::LeadPoint::losses(uint32_t lanes) const {
    LensLosses<uint32_t> out;
    out.drawn = lanes;
    if (rays_.passed[lane_]) return out;
    const RayStatus status = rays_.ray.status(lane_);
    const bool left = rays_.aimed.clear[lane_] && rays_.open[lane_] > 0 && rays_.density[lane_] > 0;
    (!rays_.aimed.found[lane_]                       ? out.unreached
     : left && status == RayStatus::TotallyReflected ? out.totally_reflected
     : left && status == RayStatus::Missed           ? out.missed
                                                     : out.vignetted) = lanes;
    return out;
}

template <class V>
LensDraw<V> LensCamera::draw(V2f film_mm, V2f u, const Bands& bands) const {
    const bool achromatic = one_ray(bands, in_.dispersion);
    LeadPoints points;
    points.film_mm.fill(film_mm);
    points.u.fill(u);
    points.nm = splat8(achromatic ? kLineD : bands.nm[bands.hero]);
    const LeadRays rays =
        optics_.aim(points, optics_.drawn_stop_mm(points), indices_of(points, achromatic));
    const Place place{film_mm, rays.stop_mm[0], bands, achromatic, V2f(1.f)};
    return Point<V>(*this, place, rays, 0).rays({bands.on, bands.hero, true});
}
template LensDraw<f4> LensCamera::draw(V2f, V2f, const Bands&) const;
template LensDraw<d4> LensCamera::draw(V2f, V2f, const Bands&) const;

LensIndices<f8> LensCamera::indices_of(const LeadPoints& points, bool achromatic) const {
    return achromatic ? line_d_of_all_ : in_.lens->indices(points.nm);
}

// The image stands on its head: what is seen on the right falls on the left of the film.
V2f LensCamera::film_mm(V2f film) const {
    return {(0.5f - film.x) * static_cast<float>(in_.film_width_mm),
            (film.y - 0.5f) * static_cast<float>(in_.film_height_mm)};
}

V2f LensCamera::film_of(V2f film_mm) const {
    return {0.5f - film_mm.x / static_cast<float>(in_.film_width_mm),
            0.5f + film_mm.y / static_cast<float>(in_.film_height_mm)};
}

auto LensCamera::batch(std::span<const FilmPoint> points, std::span<const Bands> bands) const
    -> Batch {
    Batch out{points, bands, one_ray(bands[0], in_.dispersion), false, {}, {}};
    LeadPoints& at = out.at;
    for (size_t i = 0; i < kMostFilmPoints; ++i) {
        if (i >= points.size()) {
            at.film_mm[i] = at.film_mm[0], at.u[i] = at.u[0], at.nm[i] = at.nm[0];
            continue;
        }
        at.film_mm[i] = film_mm(points[i].film);
        at.u[i] = points[i].sampler.get2(Dim::Lens);
        at.nm[i] = out.achromatic ? kLineD : bands[i].nm[bands[i].hero];
    }
    out.of_hero = out.achromatic ||
                  (in_.dispersion == DispersionMode::Hero &&
                   std::all_of(points.begin(), points.end(),
                               [](const FilmPoint& p) { return p.pixel.filter != nullptr; }));
    out.indices = indices_of(at, out.achromatic);
    return out;
}

void LensCamera::sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                            std::span<CameraSample> out) const {
    const Batch all = batch(points, bands);
    LeadRays rays = optics_.aim(all.at, optics_.drawn_stop_mm(all.at), all.indices);
    finish(all, rays, out);
}

void LensCamera::finish(const Batch& all, LeadRays& rays, std::span<CameraSample> out) const {
    const auto place = [&](size_t i) {
        return Place{all.at.film_mm[i], rays.stop_mm[static_cast<int>(i)], all.bands[i],
                     all.achromatic, all.points[i].pixel.frame_px};
    };
    const auto each = [&]<class P>(const auto&... more) {
        for (size_t i = 0; i < all.points.size(); ++i) {
            const Place here = place(i);
            out[i] = sample_lens(P(*this, here, rays, static_cast<int>(i), more[i]...),
                                 in_.dispersion, all.points[i].pixel, all.bands[i]);
        }
    };
    if (in_.precision == Precision::Double) return each.template operator()<Point<d4>>();
    if (!all.of_hero) return each.template operator()<Point<f4>>();
    optics_.trace(all.at, all.indices, rays);
    std::array<LensLanding, kMostFilmPoints> landings;
    if (!all.achromatic) land(all.points.size(), all.bands, all.at, rays, landings);
    each.template operator()<LeadPoint>(landings);
}

// Four film points at a time, so that two groups of eight lanes are full, or the last two in one.
void LensCamera::land(size_t count, std::span<const Bands> bands, const LeadPoints& at,
                      const LeadRays& rays,
                      std::array<LensLanding, kMostFilmPoints>& landings) const {
    std::array<size_t, kMostFilmPoints + 3> passed;
    size_t n = 0;
    for (size_t i = 0; i < count; ++i)
        if (rays.passed[static_cast<int>(i)]) passed[n++] = i;
    if (n == 0) return;
    std::fill_n(passed.begin() + static_cast<ptrdiff_t>(n), 3, passed[0]);
    const auto drawn = [&](size_t k) {
        const size_t i = passed[k];
        const auto lane = static_cast<int>(i);
        return DrawnRay<float>{lane_of(rays.ray, lane), bands[i].hero, at.film_mm[i],
                               rays.stop_mm[lane], bands[i].nm};
    };
    const auto indices = [&](size_t k) {
        return in_.lens->indices(joined(bands[passed[k]].nm, bands[passed[k + 1]].nm));
    };
    const auto keep = [&](size_t k, const auto& landed) {
        for (size_t m = 0; m < landed.size() && k + m < n; ++m) landings[passed[k + m]] = landed[m];
    };
    for (size_t k = 0; k < n; k += 4) {
        if (n - k <= 2)
            keep(k, optics_.land<f8, 1>({drawn(k), drawn(k + 1)}, {indices(k)}));
        else
            keep(k, optics_.land<f8, 2>({drawn(k), drawn(k + 1), drawn(k + 2), drawn(k + 3)},
                                        {indices(k), indices(k + 2)}));
    }
}

// Mean of quasi-random draws: the integrand is smooth but for the edges of iris and rims.
double LensCamera::irradiance(V2f film_mm, uint32_t count) const {
    LeadPoints at;
    at.film_mm.fill(film_mm);
    at.nm = splat8(kLineD);
    double sum = 0;
    for (uint32_t first = 0; first < count; first += kMostFilmPoints) {
        for (uint32_t i = 0; i < kMostFilmPoints; ++i)
            at.u[i] = Sampler(SamplerKind::Owen, 0, {0, 0, first + i}).get2(Dim::Lens);
        LeadRays rays = optics_.aim(at, optics_.drawn_stop_mm(at), line_d_of_all_);
        optics_.trace(at, line_d_of_all_, rays);
        for (uint32_t i = 0; i < kMostFilmPoints && first + i < count; ++i)
            if (const int lane = int(i); rays.passed[lane])
                sum += double(gain_ * rays.open[lane] / rays.density[lane]);
    }
    return sum / double(count);
}

}  // namespace petzval::camera
