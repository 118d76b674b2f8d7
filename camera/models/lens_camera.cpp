// SPDX-License-Identifier: Apache-2.0
#include "camera/models/lens_camera.h"

#include "camera/dispersion/hero.h"
#include "camera/lens/trace.h"
#include "core/spectrum/glass.h"

namespace petzval {
namespace {

template <class V>
V transmitted(const Iris& iris, V x, V y) {
    const auto at = [&](int i) {
        return iris.transmits({static_cast<float>(x[i]), static_cast<float>(y[i])});
    };
    V out = broadcast<V>(at(0));
    for (int i = 1; i < 4; ++i)
        if (x[i] != x[0] || y[i] != y[0]) out[i] = at(i);
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

// What took each lane that is on and did not pass. A rim comes before what befalls a ray behind it.
template <class V>
LensLosses<uint32_t> losses(m4 on, const LensDraw<V>& drawn, MaskOf<V> clear) {
    const auto count = [on](MaskOf<V> lanes) {
        return static_cast<uint32_t>(lane_count(on & lanes_as<m4>(lanes)));
    };
    LensLosses<uint32_t> out = drawn.lanes;
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

LensCamera::LensCamera(LensCameraInput in)
    : in_(std::move(in)),
      pose_(in_.to_world),
      aimer_(*in_.lens, in_.film_mm, 0.5 * std::hypot(in_.film_width_mm, in_.film_height_mm)),
      line_d_(in_.lens->exact_indices(splat(static_cast<float>(kLineD_nm)))),
      exact_line_d_(in_.lens->exact_indices(broadcast<d4>(kLineD_nm))) {}

// Irradiance is the integral of radiance dL dM, L and M the direction cosines at the film: the
// cosine is in it. A point drawn evenly on the iris and solved for one lane has the density
// stretch / area in (L, M); other lanes might have drawn the same direction, and all are weighed
// with the mean density (balance heuristic: Veach 1997, 9.2.3), so that light at the iris's edge is
// not lost where its image differs between wavelengths.
template <class V>
LensDraw<V> LensCamera::draw(const Aim& aim, const Bands& bands, Coating coating,
                             DispersionMode dispersion, const LensIndices<f4>& in_floats,
                             const LensIndices<V>& indices) const {
    using S = ScalarOf<V>;
    LensDraw<V> out;
    const V2f on_iris = in_.iris.sample(aim.u);
    const bool single = dispersion == DispersionMode::Single && !one_ray(bands, dispersion);
    const m4 on = single ? only_lane(aim.lane) : bands.on;
    const auto solved = aimer_.aim(aim.film_mm, on_iris, in_floats, aim.lane, aim.nm);
    out.lanes.drawn = static_cast<uint32_t>(lane_count(on));
    if (!solved) {
        out.lanes.unreached = out.lanes.drawn;
        return out;
    }
    const AimedRay<V>& c = [&]() -> decltype(auto) {
        if constexpr (std::same_as<V, f4>)
            return (*solved);
        else
            return aimer_.cross(aim.film_mm, lanes_as<V>(solved->l), lanes_as<V>(solved->m),
                                indices);
    }();
    // What the solver leaves is taken off, so that the lane crosses the iris where it was drawn:
    // an iris may be smaller than the tolerance.
    const V x = c.ray.origin.x + (S(on_iris.x) - c.ray.origin.x[aim.lane]);
    const V y = c.ray.origin.y + (S(on_iris.y) - c.ray.origin.y[aim.lane]);
    const V open =
        select(lanes_as<MaskOf<V>>(on) & c.ray.alive(), petzval::transmitted(in_.iris, x, y), V{});
    const auto lanes = static_cast<S>(out.lanes.drawn);
    const S density = sum<V>(open * c.stretch_mm2()) / (S(in_.iris.area_mm2()) * lanes);
    out.ray = c.ray;
    if (density > 0 && any(c.clear & (open > 0))) {
        static_cast<void>(trace_lens<V>(*in_.lens, indices, Towards::Scene,
                                        {0, in_.lens->stop() - 1}, out.ray, Clip::Yes));
        const S gain = S(gain_) * static_cast<S>(lane_count(bands.on)) / lanes;
        out.weight = select(c.clear & out.ray.alive(), V(open * (gain / density)), V{});
    }
    out.lanes = losses(on, out, c.clear);
    if (coating != Coating::Ideal && any(out.weight > 0)) {
        const f4 nm = bands.spectral ? bands.nm : splat(aim.nm);
        out.weight *= lanes_as<V>(transmitted(aim.film_mm, c, coating, indices, nm));
    }
    return out;
}

template <class V>
LensDraw<V> LensCamera::draw(V2f film_mm, V2f u, float u_lane, const Bands& bands, Coating coating,
                             DispersionMode dispersion) const {
    const Lens& lens = *in_.lens;
    Aim aim{film_mm, u, pick_lane(bands.on, u_lane), static_cast<float>(kLineD_nm)};
    if (one_ray(bands, dispersion)) {
        if constexpr (std::same_as<V, f4>)
            return draw(aim, bands, coating, dispersion, line_d_, line_d_);
        else
            return draw(aim, bands, coating, dispersion, line_d_, exact_line_d_);
    }
    aim.nm = bands.nm[aim.lane];
    const LensIndices<f4> indices = lens.indices(bands.nm);
    if constexpr (std::same_as<V, f4>)
        return draw(aim, bands, coating, dispersion, indices, indices);
    else
        return draw(aim, bands, coating, dispersion, indices,
                    lens.exact_indices(lanes_as<d4>(bands.nm)));
}
template LensDraw<f4> LensCamera::draw(V2f, V2f, float, const Bands&, Coating,
                                       DispersionMode) const;
template LensDraw<d4> LensCamera::draw(V2f, V2f, float, const Bands&, Coating,
                                       DispersionMode) const;

template <class V>
f4 LensCamera::transmitted(V2f film_mm, const AimedRay<V>& c, Coating coating,
                           const LensIndices<V>& indices, f4 nm) const {
    const Lens& lens = *in_.lens;
    f4 out = splat(1.f);
    const auto lose = [&](const LensHit<V>& hit) {
        const auto& s = lens.surfaces<ScalarOf<V>>()[static_cast<size_t>(hit.surface)];
        if (s.medium_before == s.medium_after) return;
        const Crossing crossing{lanes_as<f4>(hit.index),
                                lanes_as<f4>(indices.of_medium[s.medium_before]),
                                lanes_as<f4>(hit.cosine)};
        out *= transmittance(coating, crossing, touches_air(s), nm);
    };
    LensRay<V> ray = aimer_.leave(film_mm, c.l, c.m);
    static_cast<void>(
        trace_lens<V>(lens, indices, Towards::Scene, {0, lens.last()}, ray, Clip::No, lose));
    return out;
}

template <class V>
Ray LensCamera::world_ray(const LensRay<V>& ray, int lane) const {
    using S = ScalarOf<V>;
    const auto &o = ray.origin, &d = ray.direction;
    const V3f point_m(static_cast<float>(o.x[lane] * S(1e-3)),
                      static_cast<float>(o.y[lane] * S(1e-3)),
                      static_cast<float>(behind_pupil_mm(ray, lane) * S(1e-3)));
    const V3f direction(static_cast<float>(d.x[lane]), static_cast<float>(d.y[lane]),
                        static_cast<float>(d.z[lane]));
    Ray out;
    out.origin = pose_.origin + pose_.to_world(point_m);
    out.direction = unit(pose_.to_world(direction));
    return out;
}

template <class V>
ScalarOf<V> LensCamera::behind_pupil_mm(const LensRay<V>& ray, int lane) const {
    return static_cast<ScalarOf<V>>(ray.origin.z[lane] + in_.lens->vertex_mm(ray.counted_from) -
                                    in_.entrance_pupil_mm);
}

// Whether two lanes meet the plane of focus within the tolerance, seen from the lens.
template <class V>
bool LensCamera::together(const LensRay<V>& ray, int a, int b, DispersionMode dispersion) const {
    using S = ScalarOf<V>;
    if (dispersion == DispersionMode::Split || dispersion == DispersionMode::Hero) return false;
    const float focus_mm = in_.focus_m * 1e3f;
    const auto on_plane = [&](int lane) {
        const S t = (S(focus_mm) + behind_pupil_mm(ray, lane)) / -ray.direction.z[lane];
        return V2f(static_cast<float>(ray.origin.x[lane] + t * ray.direction.x[lane]),
                   static_cast<float>(ray.origin.y[lane] + t * ray.direction.y[lane]));
    };
    // A fisheye's rays that lead backwards never meet the plane: no guess is made about them.
    if (!(ray.direction.z[a] < 0 && ray.direction.z[b] < 0)) return false;
    return (on_plane(a) - on_plane(b)).length() <= in_.tolerance_rad * focus_mm;
}

template <class V>
CameraSample LensCamera::paths(const LensDraw<V>& drawn, const Bands& bands,
                               DispersionMode dispersion) const {
    CameraSample out;
    out.lanes = drawn.lanes;
    out.exposure = exposure_;
    m4 left = lanes_as<m4>(drawn.weight > 0);
    // Lanes that go nearly the same way share the first one's ray.
    for (int lane = 0; lane < 4; ++lane) {
        if (!left[lane]) continue;
        CameraPath& path = out.add();
        path.ray = world_ray(drawn.ray, lane);
        path.lanes = left;
        for (int other = lane + 1; other < 4; ++other)
            if (!one_ray(bands, dispersion) && left[other] &&
                !together(drawn.ray, lane, other, dispersion))
                path.lanes[other] = 0;
        path.weight = zero_off(path.lanes, lanes_as<f4>(drawn.weight));
        left &= ~path.lanes;
    }
    return out;
}

// The ray of one lane, as `single` draws it, goes back through the lens in all lanes. What rounding
// and the solver leave shows in the drawn lane, whose way is known, and is taken off all of them.
template <class V>
CameraSample LensCamera::hero(const FilmPoint& point, V2f film_mm, const Bands& bands) const {
    using S = ScalarOf<V>;
    const Lens& lens = *in_.lens;
    const V2f u = point.sampler.get2(Dim::Lens);
    const int lead = pick_lane(bands.on, point.sampler.get1(Dim::LensLane));
    const LensIndices<f4> in_floats = lens.indices(bands.nm);
    const LensIndices<V>& indices = [&]() -> decltype(auto) {
        if constexpr (std::same_as<V, f4>)
            return (in_floats);
        else
            return lens.exact_indices(lanes_as<d4>(bands.nm));
    }();
    const LensDraw<V> drawn = draw({film_mm, u, lead, bands.nm[lead]}, bands, Coating::Ideal,
                                   DispersionMode::Single, in_floats, indices);
    CameraSample out;
    out.lanes = drawn.lanes;
    out.exposure = exposure_;
    if (!(drawn.weight[lead] > 0)) return out;

    f4 through = splat(1.f);
    const auto lose = [&](const LensHit<V>& hit) {
        const auto& s = lens.surfaces<S>()[static_cast<size_t>(hit.surface)];
        if (in_.coating == Coating::Ideal || s.medium_before == s.medium_after) return;
        const Crossing crossing{lanes_as<f4>(hit.index),
                                lanes_as<f4>(indices.of_medium[s.medium_after]),
                                lanes_as<f4>(hit.cosine)};
        through *= transmittance(in_.coating, crossing, touches_air(s), bands.nm);
    };
    const auto of_lead = [&](V a, S sign) { return broadcast<V>(sign * a[lead]); };
    LensRay<V> ray;
    ray.counted_from = drawn.ray.counted_from;
    const auto &o = drawn.ray.origin, &d = drawn.ray.direction;
    ray.origin = {of_lead(o.x, 1), of_lead(o.y, 1), of_lead(o.z, 1)};
    ray.direction = {of_lead(d.x, -1), of_lead(d.y, -1), of_lead(d.z, -1)};
    static_cast<void>(
        trace_lens<V>(lens, indices, Towards::Film, {0, lens.stop()}, ray, Clip::Yes, lose));
    const V2f on_iris = in_.iris.sample(u);
    const V x = ray.origin.x + (S(on_iris.x) - ray.origin.x[lead]);
    const V y = ray.origin.y + (S(on_iris.y) - ray.origin.y[lead]);
    const V iris = petzval::transmitted(in_.iris, x, y);
    const MaskOf<V> arrived = trace_lens<V>(lens, indices, Towards::Film,
                                            {lens.stop() + 1, lens.last()}, ray, Clip::Yes, lose);
    const f4 open = lanes_as<f4>(select(arrived, iris, V{}));
    const V to_film =
        (S(in_.film_mm - lens.vertex_mm(ray.counted_from)) - ray.origin.z) / ray.direction.z;
    const V film_x = ray.origin.x + to_film * ray.direction.x;
    const V film_y = ray.origin.y + to_film * ray.direction.y;
    // The image stands on its head.
    const f4 dx_px =
        lanes_as<f4>(V((film_x[lead] - film_x) / S(in_.film_width_mm))) * point.pixel.frame_px.x;
    const f4 dy_px =
        lanes_as<f4>(V((film_y - film_y[lead]) / S(in_.film_height_mm))) * point.pixel.frame_px.y;
    const f4 shares = hero_shares(point.pixel, dx_px, dy_px, bands.on, open);
    // `single` has weighed its one lane for all that are on.
    const f4 weight =
        shares * through *
        (static_cast<float>(drawn.weight[lead]) / static_cast<float>(lane_count(bands.on)));
    const m4 reached = weight > 0;
    if (lane_count(reached) == 0) return out;
    CameraPath& path = out.add();
    path.ray = world_ray(drawn.ray, lead);
    path.weight = weight;
    path.lanes = reached;
    return out;
}

CameraSample LensCamera::sample(const FilmPoint& point, const Bands& bands) const {
    // The image stands on its head: what is seen on the right falls on the left of the film.
    const V2f film((0.5f - point.film.x) * static_cast<float>(in_.film_width_mm),
                   (point.film.y - 0.5f) * static_cast<float>(in_.film_height_mm));
    if (in_.dispersion == DispersionMode::Hero && bands.spectral && point.pixel.filter)
        return in_.precision == Precision::Double ? hero<d4>(point, film, bands)
                                                  : hero<f4>(point, film, bands);
    const V2f u = point.sampler.get2(Dim::Lens);
    const float u_lane = point.sampler.get1(Dim::LensLane);
    const auto drawn = [&]<class V>(V) {
        return paths(draw<V>(film, u, u_lane, bands, in_.coating, in_.dispersion), bands,
                     in_.dispersion);
    };
    return in_.precision == Precision::Double ? drawn(d4{}) : drawn(f4{});
}

// Smooth but for the edges of the iris and of the rims.
double LensCamera::irradiance(V2f film_mm, uint32_t count) const {
    const Bands bands = Bands::rgb();
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const V2f u = Sampler(SamplerKind::Owen, 0, {0, 0, i}).get2(Dim::Lens);
        sum += hsum(draw<f4>(film_mm, u, 0.f, bands, Coating::Ideal, in_.dispersion).weight);
    }
    return sum / (double(count) * lane_count(bands.on));
}

}  // namespace petzval
