// SPDX-License-Identifier: Apache-2.0
// Ray tracing through a lens, in either direction, four or eight rays at once.
#pragma once

#include <array>
#include <limits>

#include "camera/lens/lens.h"
#include "camera/lens/lens_ray.h"
#include "camera/lens/number.h"

namespace petzval::camera {

/// A passage through the surfaces of a range, in one of two directions.
struct LensPassage {
    const Lens& lens;
    Towards towards;
    SurfaceRange range;
    Clip clip;

    [[nodiscard]] bool to_film() const { return towards == Towards::Film; }
    [[nodiscard]] bool empty() const { return range.first > range.last; }
    [[nodiscard]] bool contains(int surface) const {
        return range.first <= surface && surface <= range.last;
    }
    /// The first surface on the way, and what leads from each to the next.
    [[nodiscard]] int begin() const { return to_film() ? range.first : range.last; }
    [[nodiscard]] int step() const { return to_film() ? 1 : -1; }
};

namespace lens_trace {

/// Intersection of a ray with a surface. normal: unit, along the light that crosses the surface.
/// The cosine of incidence and its square, as the square is there before the root.
template <class V>
struct Meeting {
    V distance;
    Vec3<V> point, normal;
    V cosine, cosine2;
    MaskOf<V> found;
    V per_gradient;  ///< 1 over the length of the gradient of which the normal is made; sphere: 1
};

template <class N>
[[nodiscard]] N or_zero(N a) {
    return select(value_of(a) > 0, a, N{});
}
/// Inverse of a, or 0 where a is not above 0: for derivatives, which grow beyond all bounds where
/// light grazes.
template <class V>
[[nodiscard]] V inverse_or_zero(V a) {
    return select(a > 0, V(1 / a), V{});
}

/// The root of a t^2 + 2 b t + c = 0 at which a t + b = -sign * size, where size^2 = b^2 - a c: in
/// that one of its two forms in which nothing cancels. The choice does not wait for the size.
template <class V>
[[nodiscard]] V root_of(V a, V b, V c, ScalarOf<V> sign, V size) {
    const auto same_sign = b * sign <= 0;
    const V root = size * sign;
    return select(same_sign, c, V(-b - root)) / select(same_sign, V(root - b), a);
}

/// Intersects a sphere. `foot` is the ray's point that is nearest to the vertex: from there the
/// root has no large terms that cancel, wherever the ray came from, and B is -direction.z (Feder
/// 1951, J. Opt. Soc. Am. 41, 630); it halves what floats err, for the same time. The root is the
/// one on the sheet that has the vertex, crossed in the light's direction. Inlined, as a call would
/// cost a tenth of a draw.
template <class V>
[[nodiscard, gnu::always_inline]] inline Meeting<V> meet_sphere(ScalarOf<V> c, ScalarOf<V> sign,
                                                                const Vec3<V>& foot,
                                                                const Vec3<V>& direction) {
    const V beyond = c * dot(foot, foot) - 2 * foot.z;
    Meeting<V> hit;
    hit.cosine2 = direction.z * direction.z - c * beyond;
    hit.cosine = sqrt(or_zero(hit.cosine2));
    hit.distance = root_of<V>(broadcast<V>(c), -direction.z, beyond, sign, hit.cosine);
    hit.point = foot + direction * hit.distance;
    const V turn = hit.point.z * (sign * c);
    hit.found = (hit.cosine2 >= 0) & (turn * sign < 1);
    hit.normal = {hit.point.x * (-sign * c), hit.point.y * (-sign * c), sign - turn};
    hit.per_gradient = broadcast<V>(1);
    return hit;
}

/// Intersects the quadric curvature_x x^2 + curvature_y y^2 + curvature_z z^2 = 2 z, whose gradient
/// is not of unit length.
template <class V>
[[nodiscard]] Meeting<V> meet_quadric(const SurfaceFacts<ScalarOf<V>>& s, ScalarOf<V> sign,
                                      const Vec3<V>& foot, const Vec3<V>& direction) {
    const auto curved = [&s](const Vec3<V>& a) {
        return Vec3<V>{a.x * s.curvature_x, a.y * s.curvature_y, a.z * s.curvature_z};
    };
    const V a = dot(curved(direction), direction);
    const V b = dot(curved(direction), foot) - direction.z;
    const V c = dot(curved(foot), foot) - 2 * foot.z;
    const V discriminant = b * b - a * c;
    const V root = sqrt(or_zero(discriminant));
    Meeting<V> hit;
    hit.distance = root_of<V>(a, b, c, sign, root);
    hit.point = foot + direction * hit.distance;
    const V sheet = 1 - s.curvature_z * hit.point.z;
    hit.found = (discriminant >= 0) & (sheet > 0);
    const Vec3<V> along{hit.point.x * (-s.curvature_x), hit.point.y * (-s.curvature_y), sheet};
    hit.per_gradient = 1 / sqrt(dot(along, along));
    hit.normal = along * (sign * hit.per_gradient);
    hit.cosine = dot(hit.normal, direction);
    hit.cosine2 = hit.cosine * hit.cosine;
    return hit;
}

/// Sag of an asphere and its slope divided by r, d sag / dr / r: infinite where r is beyond the
/// conic.
template <class N>
struct Sag {
    N height, slope_by_r;
};

template <class N>
[[nodiscard]] Sag<N> sag_at(const Asphere<ScalarOf<N>>& s, const N& r2) {
    const N under_root = 1 - (s.one_plus_k * s.curvature * s.curvature) * r2;
    const N root = sqrt(or_zero(under_root));
    N even{}, even_slope{}, odd{}, odd_slope{};
    for (size_t i = s.even.size(); i-- > 0;) {
        even = even * r2 + s.even[i];
        even_slope = even_slope * r2 + s.even[i] * ScalarOf<N>(2 * i + 2);
    }
    for (size_t i = s.odd.size(); i-- > 0;) {
        odd = odd * r2 + s.odd[i];
        odd_slope = odd_slope * r2 + s.odd[i] * ScalarOf<N>(2 * i + 3);
    }
    if (!s.odd.empty()) {
        const N r = sqrt(r2);
        even = even + odd * r;
        even_slope = even_slope + odd_slope * r;
    }
    return {s.curvature * r2 / (1 + root) + even * r2, s.curvature / root + even_slope};
}

/// r^2 of a point for an asphere: x^2 and y^2, as far as the asphere goes by them.
template <class V>
[[nodiscard]] V r2_of(const Asphere<ScalarOf<V>>& s, const Vec3<V>& p) {
    return p.x * p.x * s.across_x + p.y * p.y * s.across_y;
}

/// Intersects an asphere by Newton's method from the quadric's point. Each lane stops when it has
/// converged, so that what it finds does not depend on its neighbours. One more step squares what
/// error is left.
template <class V>
[[nodiscard]] Meeting<V> meet_asphere(const SurfaceFacts<ScalarOf<V>>& facts,
                                      const Asphere<ScalarOf<V>>& s, ScalarOf<V> sign,
                                      const Vec3<V>& foot, const Vec3<V>& direction) {
    using S = ScalarOf<V>;
    constexpr int kIterations = 12;
    // Newton squares the relative error: after this, one step reaches the last digit.
    constexpr S kConverged = sizeof(S) == sizeof(float) ? S(1e-4) : S(1e-8);
    const auto step = [&](const Vec3<V>& p) {
        const Sag<V> sag = sag_at<V>(s, r2_of<V>(s, p));
        const V slope = direction.z - sag.slope_by_r * (p.x * direction.x * s.across_x +
                                                        p.y * direction.y * s.across_y);
        return (sag.height - p.z) / slope;
    };
    V distance = meet_quadric<V>(facts, sign, foot, direction).distance;
    MaskOf<V> converged = distance != distance;
    for (int i = 0; i < kIterations && !all(converged); ++i) {
        const Vec3<V> p = foot + direction * distance;
        const V by = step(p);
        distance = select(converged, distance, V(distance + by));
        const V size2 = dot(p, p) + distance * distance;
        converged = converged | (by * by <= (kConverged * kConverged) * size2);
    }
    Meeting<V> hit;
    hit.distance = step(foot + direction * distance) + distance;
    hit.point = foot + direction * hit.distance;
    const Sag<V> sag = sag_at<V>(s, r2_of<V>(s, hit.point));
    const Vec3<V> ahead{hit.point.x * sag.slope_by_r * (-s.across_x),
                        hit.point.y * sag.slope_by_r * (-s.across_y), broadcast<V>(1)};
    hit.per_gradient = 1 / sqrt(dot(ahead, ahead));
    hit.normal = ahead * (sign * hit.per_gradient);
    hit.cosine = dot(hit.normal, direction);
    hit.cosine2 = hit.cosine * hit.cosine;
    // An infinite slope makes the cosine NaN; one whose square is infinite makes it 0.
    hit.found = converged & (hit.cosine > 0);
    return hit;
}

/// Change of the unit normal as the point moves along the surface.
template <class V>
class NormalChange {
    using S = ScalarOf<V>;

  public:
    NormalChange(const SurfaceFacts<S>& facts, const Asphere<S>* asphere, S sign,
                 const Meeting<V>& hit)
        : facts_(facts), asphere_(asphere), sign_(sign), hit_(hit) {
        if (!asphere) return;
        const Dual<V> r2{r2_of<V>(*asphere, hit.point), broadcast<V>(1), V{}};
        const Sag<Dual<V>> sag = sag_at<Dual<V>>(*asphere, r2);
        slope_by_r_ = sag.slope_by_r.value;
        by_r2_ = sag.slope_by_r.du;
    }
    [[nodiscard]] Vec3<V> operator()(const Vec3<V>& moved) const {
        if (facts_.shape == Shape::Sphere) return moved * (-sign_ * facts_.curvature_y);
        const Vec3<V> turned = gradient(moved) * (sign_ * hit_.per_gradient);
        return turned + hit_.normal * -dot(hit_.normal, turned);
    }

  private:
    [[nodiscard]] Vec3<V> gradient(const Vec3<V>& moved) const {
        if (!asphere_)
            return {moved.x * -facts_.curvature_x, moved.y * -facts_.curvature_y,
                    moved.z * -facts_.curvature_z};
        const V x = hit_.point.x * asphere_->across_x, y = hit_.point.y * asphere_->across_y;
        const V slope_change = 2 * (x * moved.x + y * moved.y) * by_r2_;
        return {-(moved.x * asphere_->across_x * slope_by_r_ + x * slope_change),
                -(moved.y * asphere_->across_y * slope_by_r_ + y * slope_change), V{}};
    }

    const SurfaceFacts<S>& facts_;
    const Asphere<S>* asphere_;
    S sign_;
    const Meeting<V>& hit_;
    V slope_by_r_{}, by_r2_{};
};

/// Derivative of a ray by one parameter.
template <class V>
struct RayChange {
    Vec3<V> origin, direction;
};
/// Derivatives that a ray of numbers N carries; none without a Dual.
template <class N>
struct RayChanges {
    static constexpr bool kAny = false;
    explicit RayChanges(const LensRay<N>&) {}
    void keep(MaskOf<N>) {}
    void put_into(LensRay<N>&) const {}
};
template <class V>
struct RayChanges<Dual<V>> {
    static constexpr bool kAny = true;
    RayChange<V> by[2];

    explicit RayChanges(const LensRay<Dual<V>>& ray) {
        const auto &o = ray.origin, &d = ray.direction;
        by[0] = {{o.x.du, o.y.du, o.z.du}, {d.x.du, d.y.du, d.z.du}};
        by[1] = {{o.x.dv, o.y.dv, o.z.dv}, {d.x.dv, d.y.dv, d.z.dv}};
    }
    void keep(MaskOf<V> on) {
        for (RayChange<V>& c : by)
            c = {select(on, c.origin, Vec3<V>{}), select(on, c.direction, Vec3<V>{})};
    }
    void put_into(LensRay<Dual<V>>& ray) const {
        const auto put = [this](Vec3<Dual<V>>& to, auto which) {
            const Vec3<V>&u = by[0].*which, &v = by[1].*which;
            to.x.du = u.x, to.y.du = u.y, to.z.du = u.z;
            to.x.dv = v.x, to.y.dv = v.y, to.z.dv = v.z;
        };
        put(ray.origin, &RayChange<V>::origin);
        put(ray.direction, &RayChange<V>::direction);
    }
};

/// Ray in another number type: its values, or values put into one that has derivatives.
template <class To, class From>
[[nodiscard]] LensRay<To> converted(const LensRay<From>& ray) {
    if constexpr (std::same_as<To, From>)
        return ray;
    else {
        const auto vector = [](const Vec3<From>& a) {
            if constexpr (std::same_as<To, ValueOf<From>>)
                return value_of(a);
            else
                return Vec3<To>{constant<To>(a.x), constant<To>(a.y), constant<To>(a.z)};
        };
        return {vector(ray.origin), vector(ray.direction), ray.counted_from, ray.status_code,
                ray.end_surface};
    }
}

/// Gives a status to lanes that are blocked just now, and the axis for a ray to all blocked ones.
template <class N>
[[gnu::noinline]] LensRay<N> block(LensRay<N> ray, int surface, ScalarOf<N> sign, MaskOf<N> found,
                                   MaskOf<N> inside, MaskOf<N> refracted) {
    using Code = CodeOf<N>;
    const auto code = [](auto a) { return Code{} + static_cast<int>(a); };
    const MaskOf<N> fresh = ray.alive() & !(found & inside & refracted);
    const Code status =
        select(!found, code(RayStatus::Missed),
               select(!inside, code(RayStatus::Vignetted), code(RayStatus::TotallyReflected)));
    ray.status_code = select(fresh, status, ray.status_code);
    ray.end_surface = select(fresh, code(surface), ray.end_surface);
    const MaskOf<N> on = ray.alive();
    ray.origin = select(on, ray.origin, Vec3<N>{});
    ray.direction = select(on, ray.direction, Vec3<N>{N{}, N{}, broadcast<N>(sign)});
    return ray;
}

/// A ray on its way through a lens, with the derivatives that it may carry.
template <class N>
struct OnTheWay {
    LensRay<ValueOf<N>> ray;
    RayChanges<N> changes;
    /// From where it is to the vertex of the first surface that it is traced to.
    OnTheWay(const Lens& lens, const LensRay<N>& from, int begin)
        : ray(converted<ValueOf<N>>(from)), changes(from) {
        if (ray.counted_from == begin) return;
        ray.origin.z =
            ray.origin.z + ScalarOf<N>(lens.vertex_mm(ray.counted_from) - lens.vertex_mm(begin));
    }
    void put_into(LensRay<N>& traced) const {
        traced = converted<N>(ray);
        changes.put_into(traced);
    }
};

/// Follows a ray to surface i of a passage and through it.
template <class N, class Observer>
[[gnu::always_inline]] inline void cross_surface(const LensPassage& through,
                                                 const LensIndices<ValueOf<N>>& indices, int i,
                                                 const Observer& observe, OnTheWay<N>& on_the_way) {
    using V = ValueOf<N>;
    using S = ScalarOf<N>;
    const Lens& lens = through.lens;
    const bool to_film = through.to_film();
    const S sign = to_film ? S(1) : S(-1);
    const SurfaceFacts<S>* const facts = lens.surfaces<S>().data();
    const SurfaceFacts<S>& s = facts[i];
    LensRay<V>& ray = on_the_way.ray;
    RayChanges<N>& changes = on_the_way.changes;
    ray.counted_from = i;
    if (i != through.begin())
        ray.origin.z = ray.origin.z - (to_film ? facts[i - 1].gap_mm : -s.gap_mm);
    const V to_foot = -dot(ray.origin, ray.direction);
    const Vec3<V> foot = ray.origin + ray.direction * to_foot;
    const Asphere<S>* const asphere =
        s.shape == Shape::Asphere ? &lens.aspheres<S>()[s.asphere] : nullptr;
    const Meeting<V> hit = s.shape == Shape::Sphere
                               ? meet_sphere<V>(s.curvature_y, sign, foot, ray.direction)
                           : asphere ? meet_asphere<V>(s, *asphere, sign, foot, ray.direction)
                                     : meet_quadric<V>(s, sign, foot, ray.direction);
    const V distance = hit.distance + to_foot;
    ray.origin = hit.point;
    const V x = hit.point.x, y = hit.point.y;
    const MaskOf<V> inside =
        x * x + y * y <=
        (through.clip == Clip::Yes ? s.semi_diameter2_mm2 : std::numeric_limits<S>::infinity());
    const int from = to_film ? s.medium_before : s.medium_after;
    const int into = to_film ? s.medium_after : s.medium_before;
    observe(LensHit<V>{i, hit.point, distance, hit.cosine, indices.of_medium[from],
                       MaskOf<V>(ray.alive() & hit.found)});
    if constexpr (RayChanges<N>::kAny) {
        const V per_cosine = inverse_or_zero(hit.cosine);
        for (auto& c : changes.by) {
            c.origin = c.origin + c.direction * distance;
            c.origin = c.origin + ray.direction * (-dot(hit.normal, c.origin) * per_cosine);
        }
    }
    MaskOf<V> refracted = !MaskOf<V>{};
    if (from != into) {
        const V ratio = indices.of_medium[from] / indices.of_medium[into];
        const V cosine2 = 1 - ratio * ratio * (1 - hit.cosine2);
        refracted = cosine2 >= 0;
        const V cosine = sqrt(or_zero(cosine2)), bend = cosine - hit.cosine * ratio;
        if constexpr (RayChanges<N>::kAny) {
            const NormalChange<V> turned(s, asphere, sign, hit);
            const V by_cosine = ratio * (ratio * hit.cosine * inverse_or_zero(cosine) - 1);
            for (auto& c : changes.by) {
                const Vec3<V> turn = turned(c.origin);
                const V change = dot(c.direction, hit.normal) + dot(ray.direction, turn);
                c.direction = c.direction * ratio + turn * bend + hit.normal * (change * by_cosine);
            }
        }
        ray.direction = ray.direction * ratio + hit.normal * bend;
    }
    if (!all(hit.found & inside & refracted)) [[unlikely]] {
        ray = block(ray, i, sign, hit.found, inside, refracted);
        changes.keep(ray.alive());
    }
}

}  // namespace lens_trace

/// Traces a ray through the surfaces of a range, from anywhere on its line: backwards along it to
/// the first surface is as good as forwards. It ends on the last surface, refracted. Returns the
/// lanes that passed. N: float, f4, f8, d4, or Dual of one of the last three; the observer is
/// called with a LensHit<ValueOf<N>>.
///
/// Refraction in vector form (Welford 1986, Aberrations of Optical Systems, ch. 4). Derivatives go
/// from surface to surface as those of points, normals and directions (Igehy 1999, Tracing Ray
/// Differentials, sec. 3): a third of what Dual's own arithmetic would cost. Any input has a
/// defined result; NaN misses.
template <class N, class Observer = NoObserver>
[[nodiscard]] MaskOf<N> trace_lens(const LensPassage& through,
                                   const LensIndices<ValueOf<N>>& indices, LensRay<N>& traced,
                                   const Observer& observe = {}) {
    if (through.empty()) return traced.alive();
    lens_trace::OnTheWay<N> one(through.lens, traced, through.begin());
    for (int i = through.begin(); through.contains(i); i += through.step()) {
        lens_trace::cross_surface(through, indices, i, observe, one);
        if (!any(one.ray.alive())) [[unlikely]]
            break;
    }
    one.put_into(traced);
    return traced.alive();
}

/// Traces two rays side by side, as trace_lens() does each by itself. A ray is a chain in which all
/// waits for what is before: the second one costs little. The observer gets 0 or 1 first.
template <class N, class Observer = NoObserver>
void trace_two(const LensPassage& through, const std::array<LensIndices<ValueOf<N>>, 2>& indices,
               std::array<LensRay<N>, 2>& traced, const Observer& observe = {}) {
    if (through.empty()) return;
    lens_trace::OnTheWay<N> one(through.lens, traced[0], through.begin()),
        other(through.lens, traced[1], through.begin());
    const auto of_one = [&](const auto& hit) { observe(0, hit); };
    const auto of_other = [&](const auto& hit) { observe(1, hit); };
    for (int i = through.begin(); through.contains(i); i += through.step()) {
        lens_trace::cross_surface(through, indices[0], i, of_one, one);
        lens_trace::cross_surface(through, indices[1], i, of_other, other);
        if (!any(one.ray.alive() | other.ray.alive())) [[unlikely]]
            break;
    }
    one.put_into(traced[0]);
    other.put_into(traced[1]);
}

}  // namespace petzval::camera
