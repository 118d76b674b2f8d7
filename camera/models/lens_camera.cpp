// SPDX-License-Identifier: Apache-2.0
#include "camera/models/lens_camera.h"

#include "camera/dispersion/strategies.h"
#include "camera/lens/trace.h"
#include "core/spectrum/glass.h"

namespace petzval {
namespace {

// Distance at which wavelengths are compared for a lens that is focused at infinity.
constexpr float kFarthest_m = 1e9f;

// Transmission of the stop at a point of each lane: that of the iris inside the rim.
template <class V>
V stop_transmission(const Iris& iris, const Lens& lens, V x, V y) {
    const auto at = [&](int i) {
        return iris.transmits({static_cast<float>(x[i]), static_cast<float>(y[i])});
    };
    V out = broadcast<V>(at(0));
    for (int i = 1; i < 4; ++i)
        if (x[i] != x[0] || y[i] != y[0]) out[i] = at(i);
    const auto stop = static_cast<size_t>(lens.stop());
    const auto rim2_mm2 = lens.surfaces<ScalarOf<V>>()[stop].semi_diameter2_mm2;
    return select(x * x + y * y <= rim2_mm2, out, V{});
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

// Loss reason per lane that is on and did not pass. A ray that a rim clips first counts as
// vignetted, whatever happens after.
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

// Transmittance of a surface for the light that was traced to it, lane by lane.
template <class V>
f4 surface_transmission(const Lens& lens, Coating coating, const LensIndices<V>& indices,
                        const LensHit<V>& hit, Towards towards, f4 nm) {
    const auto& s = lens.surfaces<ScalarOf<V>>()[static_cast<size_t>(hit.surface)];
    if (s.medium_before == s.medium_after) return splat(1.f);
    const int into = towards == Towards::Film ? s.medium_after : s.medium_before;
    const Crossing crossing{lanes_as<f4>(hit.index), lanes_as<f4>(indices.of_medium[into]),
                            lanes_as<f4>(hit.cosine)};
    return transmittance(coating, crossing, touches_air(s), nm);
}

}  // namespace

LensCamera::LensCamera(LensCameraInput in)
    : in_(std::move(in)),
      pose_(in_.to_world),
      aimer_(*in_.lens, in_.film_mm, 0.5 * std::hypot(in_.film_width_mm, in_.film_height_mm)),
      line_d_(in_.lens->exact_indices(splat(static_cast<float>(kLineD_nm)))),
      exact_line_d_(in_.lens->exact_indices(broadcast<d4>(kLineD_nm))) {
    const Lens& lens = *in_.lens;
    if (!lens.of_revolution()) return;
    const auto passes = [&](float height_mm, V2f stop_mm) {
        auto aimed =
            aimer_.aim({0.f, height_mm}, stop_mm, line_d_, 0, static_cast<float>(kLineD_nm));
        if (!aimed || !aimed->clear[0]) return false;
        static_cast<void>(trace_lens<f4>(lens, line_d_, Towards::Scene, {0, lens.stop() - 1},
                                         aimed->ray, Clip::Yes));
        return aimed->ray.alive()[0] != 0;
    };
    const auto rim_mm = static_cast<float>(
        lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm);
    // A pixel's filter reaches a little beyond the film.
    const double reach_mm = 0.51 * std::hypot(in_.film_width_mm, in_.film_height_mm);
    bounds_ =
        StopBoundsByHeight(passes, static_cast<float>(reach_mm),
                           std::min(rim_mm, in_.iris.bounding_radius_mm()), in_.iris.area_mm2());
}

template <class V>
ScalarOf<V> LensCamera::behind_pupil_mm(const LensRay<V>& ray, int lane) const {
    return static_cast<ScalarOf<V>>(ray.origin.z[lane] + in_.lens->vertex_mm(ray.counted_from) -
                                    in_.entrance_pupil_mm);
}

template <class V>
class LensCamera::Point {
    using S = ScalarOf<V>;

  public:
    /// Camera and bands must outlive it. achromatic: all lanes have the indices of line d.
    /// frame_px: width and height of the full frame, in which landing() counts.
    Point(const LensCamera& camera, V2f film_mm, const Bands& bands, bool achromatic,
          V2f frame_px = V2f(1.f))
        : c_(camera),
          film_mm_(film_mm),
          bands_(bands),
          frame_px_(frame_px),
          stop_(camera.stop_at(film_mm)),
          achromatic_(achromatic) {
        if (achromatic) return;
        own_ = lens().indices(bands.nm);
        if constexpr (std::same_as<V, d4>)
            own_exact_ = lens().exact_indices(lanes_as<d4>(bands.nm));
    }
    Point(const Point&) = delete;
    Point& operator=(const Point&) = delete;

    [[nodiscard]] LensDraw<V> rays(const LaneRequest&) const;
    [[nodiscard]] Ray ray(const LensDraw<V>&, int lane) const;
    [[nodiscard]] bool together(const LensDraw<V>&, int a, int b) const;
    [[nodiscard]] FilmLanding landing(const LensDraw<V>&, const LaneRequest&) const;
    [[nodiscard]] float exposure() const { return c_.exposure_; }

  private:
    [[nodiscard]] const Lens& lens() const { return *c_.in_.lens; }
    /// Indices in floats: the stop's ray is solved for in them; the rest is traced in V.
    [[nodiscard]] const LensIndices<f4>& in_floats() const {
        return achromatic_ ? c_.line_d_ : own_;
    }
    [[nodiscard]] const LensIndices<V>& indices() const {
        if constexpr (std::same_as<V, f4>)
            return in_floats();
        else
            return achromatic_ ? c_.exact_line_d_ : own_exact_;
    }
    /// Transmittance of the surfaces for the ray that leaves the film towards the crossing.
    [[nodiscard]] f4 transmitted(const AimedRay<V>&) const;

    struct Nothing {};
    const LensCamera& c_;
    V2f film_mm_;
    const Bands& bands_;
    V2f frame_px_;
    StopDraw stop_;
    bool achromatic_;
    LensIndices<f4> own_;
    [[no_unique_address]] std::conditional_t<std::same_as<V, d4>, LensIndices<d4>, Nothing>
        own_exact_;
};

// Weights of a draw. Irradiance is the integral of radiance dL dM, L and M the direction cosines at
// the film: the cosine is in it. A point drawn on the stop and solved for one lane has its density
// times stretch in (L, M); other lanes might have drawn the same direction, and all are weighed
// with the mean density (balance heuristic: Veach 1997, 9.2.3), so that light at the iris's
// edge is not lost where its image differs between wavelengths.
template <class V>
LensDraw<V> LensCamera::Point<V>::rays(const LaneRequest& request) const {
    const LensCameraInput& in = c_.in_;
    LensDraw<V> out;
    const V2f on_iris = stop_.sample(request.u);
    const float nm = achromatic_ ? static_cast<float>(kLineD_nm) : bands_.nm[request.lead];
    const auto solved = c_.aimer_.aim(film_mm_, on_iris, in_floats(), request.lead, nm);
    out.losses.drawn = static_cast<uint32_t>(lane_count(request.lanes));
    if (!solved) {
        out.losses.unreached = out.losses.drawn;
        return out;
    }
    const AimedRay<V>& aimed = [&]() -> decltype(auto) {
        if constexpr (std::same_as<V, f4>)
            return (*solved);
        else
            return c_.aimer_.cross(film_mm_, lanes_as<V>(solved->l), lanes_as<V>(solved->m),
                                   indices());
    }();
    // The solver's residual is taken off, so that the lane crosses the iris where it was drawn: an
    // iris may be smaller than the tolerance.
    const V x = aimed.ray.origin.x + (S(on_iris.x) - aimed.ray.origin.x[request.lead]);
    const V y = aimed.ray.origin.y + (S(on_iris.y) - aimed.ray.origin.y[request.lead]);
    const MaskOf<V> there = lanes_as<MaskOf<V>>(request.lanes) & aimed.ray.alive();
    const V open = select(there, stop_transmission(in.iris, lens(), x, y), V{});
    const auto lanes = static_cast<S>(out.losses.drawn);
    // Also of lanes for which the iris is shut there: bounds overhang it.
    V of_point{};
    for (int i = 0; i < 4; ++i)
        if (there[i])
            of_point[i] = stop_.density({static_cast<float>(x[i]), static_cast<float>(y[i])},
                                        static_cast<float>(open[i]));
    const S density = sum<V>(of_point * aimed.stretch_mm2()) / lanes;
    out.ray = aimed.ray;
    if (density > 0 && any(aimed.clear & (open > 0))) {
        static_cast<void>(trace_lens<V>(lens(), indices(), Towards::Scene, {0, lens().stop() - 1},
                                        out.ray, Clip::Yes));
        const S gain = S(c_.gain_) * static_cast<S>(lane_count(bands_.on)) / lanes;
        out.weight = select(aimed.clear & out.ray.alive(), V(open * (gain / density)), V{});
    }
    out.losses = losses(request.lanes, out, aimed.clear);
    if (request.coated && in.coating != Coating::Ideal && any(out.weight > 0))
        out.weight *= lanes_as<V>(transmitted(aimed));
    return out;
}

template <class V>
f4 LensCamera::Point<V>::transmitted(const AimedRay<V>& aimed) const {
    const f4 nm = bands_.spectral ? bands_.nm : splat(static_cast<float>(kLineD_nm));
    f4 out = splat(1.f);
    const auto lose = [&](const LensHit<V>& hit) {
        out *= surface_transmission(lens(), c_.in_.coating, indices(), hit, Towards::Scene, nm);
    };
    LensRay<V> ray = c_.aimer_.leave(film_mm_, aimed.l, aimed.m);
    static_cast<void>(
        trace_lens<V>(lens(), indices(), Towards::Scene, {0, lens().last()}, ray, Clip::No, lose));
    return out;
}

template <class V>
Ray LensCamera::Point<V>::ray(const LensDraw<V>& rays, int lane) const {
    const auto &o = rays.ray.origin, &d = rays.ray.direction;
    const V3f point_m(static_cast<float>(o.x[lane] * S(1e-3)),
                      static_cast<float>(o.y[lane] * S(1e-3)),
                      static_cast<float>(c_.behind_pupil_mm(rays.ray, lane) * S(1e-3)));
    const V3f direction(static_cast<float>(d.x[lane]), static_cast<float>(d.y[lane]),
                        static_cast<float>(d.z[lane]));
    Ray out;
    out.origin = c_.pose_.origin + c_.pose_.to_world(point_m);
    out.direction = unit(c_.pose_.to_world(direction));
    return out;
}

// Whether two lanes meet the plane of focus within the tolerance, seen from the lens.
template <class V>
bool LensCamera::Point<V>::together(const LensDraw<V>& rays, int a, int b) const {
    const LensRay<V>& ray = rays.ray;
    const float focus_mm = std::fmin(c_.in_.focus_m, kFarthest_m) * 1e3f;
    const auto on_plane = [&](int lane) {
        const S t = (S(focus_mm) + c_.behind_pupil_mm(ray, lane)) / -ray.direction.z[lane];
        return V2f(static_cast<float>(ray.origin.x[lane] + t * ray.direction.x[lane]),
                   static_cast<float>(ray.origin.y[lane] + t * ray.direction.y[lane]));
    };
    // A fisheye's rays that lead backwards never meet the plane: no guess is made about them.
    if (!(ray.direction.z[a] < 0 && ray.direction.z[b] < 0)) return false;
    return (on_plane(a) - on_plane(b)).length() <= c_.in_.tolerance_rad * focus_mm;
}

// Landing: the lead's ray goes back through the lens in all lanes. What rounding and the solver
// leave shows in the lead, whose way is known, and is taken off all of them.
template <class V>
FilmLanding LensCamera::Point<V>::landing(const LensDraw<V>& rays,
                                          const LaneRequest& request) const {
    const LensCameraInput& in = c_.in_;
    const int lead = request.lead;
    FilmLanding out;
    out.transmitted = splat(1.f);
    const auto lose = [&](const LensHit<V>& hit) {
        if (in.coating != Coating::Ideal)
            out.transmitted *=
                surface_transmission(lens(), in.coating, indices(), hit, Towards::Film, bands_.nm);
    };
    const auto of_lead = [&](V a, S sign) { return broadcast<V>(sign * a[lead]); };
    LensRay<V> ray;
    ray.counted_from = rays.ray.counted_from;
    const auto &o = rays.ray.origin, &d = rays.ray.direction;
    ray.origin = {of_lead(o.x, 1), of_lead(o.y, 1), of_lead(o.z, 1)};
    ray.direction = {of_lead(d.x, -1), of_lead(d.y, -1), of_lead(d.z, -1)};
    const int stop = lens().stop();
    static_cast<void>(
        trace_lens<V>(lens(), indices(), Towards::Film, {0, stop - 1}, ray, Clip::Yes, lose));
    static_cast<void>(trace_lens<V>(lens(), indices(), Towards::Film, {stop, stop}, ray, Clip::No));
    const V2f on_iris = stop_.sample(request.u);
    const V x = ray.origin.x + (S(on_iris.x) - ray.origin.x[lead]);
    const V y = ray.origin.y + (S(on_iris.y) - ray.origin.y[lead]);
    const V iris = stop_transmission(in.iris, lens(), x, y);
    const MaskOf<V> arrived = trace_lens<V>(lens(), indices(), Towards::Film,
                                            {stop + 1, lens().last()}, ray, Clip::Yes, lose);
    out.open = lanes_as<f4>(select(arrived, iris, V{}));
    const V to_film =
        (S(in.film_mm - lens().vertex_mm(ray.counted_from)) - ray.origin.z) / ray.direction.z;
    const V film_x = ray.origin.x + to_film * ray.direction.x;
    const V film_y = ray.origin.y + to_film * ray.direction.y;
    for (int i = 0; i < 4; ++i) {
        const V2f shift(static_cast<float>(film_x[i] - film_x[lead]),
                        static_cast<float>(film_y[i] - film_y[lead]));
        const V2f stop_mm(static_cast<float>(x[i]), static_cast<float>(y[i]));
        out.drawn[i] = c_.stop_at(film_mm_ + shift).density(stop_mm, out.open[i]);
    }
    // The image stands on its head.
    out.dx_px = lanes_as<f4>(V((film_x[lead] - film_x) / S(in.film_width_mm))) * frame_px_.x;
    out.dy_px = lanes_as<f4>(V((film_y - film_y[lead]) / S(in.film_height_mm))) * frame_px_.y;
    return out;
}

template <class V>
LensDraw<V> LensCamera::draw(V2f film_mm, V2f u, const Bands& bands) const {
    const bool achromatic = one_ray(bands, in_.dispersion);
    const int lead = bands.lead;
    const bool single = in_.dispersion == DispersionMode::Single && !achromatic;
    return Point<V>(*this, film_mm, bands, achromatic)
        .rays({u, single ? only_lane(lead) : bands.on, lead, true});
}
template LensDraw<f4> LensCamera::draw(V2f, V2f, const Bands&) const;
template LensDraw<d4> LensCamera::draw(V2f, V2f, const Bands&) const;

CameraSample LensCamera::sample(const FilmPoint& point, const Bands& bands) const {
    // The image stands on its head: what is seen on the right falls on the left of the film.
    const V2f film((0.5f - point.film.x) * static_cast<float>(in_.film_width_mm),
                   (point.film.y - 0.5f) * static_cast<float>(in_.film_height_mm));
    const bool achromatic = one_ray(bands, in_.dispersion);
    if (in_.precision == Precision::Double)
        return sample_lens(Point<d4>(*this, film, bands, achromatic, point.pixel.frame_px),
                           in_.dispersion, point, bands);
    return sample_lens(Point<f4>(*this, film, bands, achromatic, point.pixel.frame_px),
                       in_.dispersion, point, bands);
}

// Mean of quasi-random draws: the integrand is smooth but for the edges of iris and rims.
double LensCamera::irradiance(V2f film_mm, uint32_t count) const {
    const Bands bands = Bands::rgb();
    const Point<f4> film_point(*this, film_mm, bands, true);
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const V2f u = Sampler(SamplerKind::Owen, 0, {0, 0, i}).get2(Dim::Lens);
        sum += hsum(film_point.rays({u, bands.on, bands.lead, false}).weight);
    }
    return sum / (double(count) * lane_count(bands.on));
}

}  // namespace petzval
