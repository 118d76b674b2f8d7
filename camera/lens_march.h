// SPDX-License-Identifier: Apache-2.0
// Rays through a lens, in either direction, four wavelengths at once.
#pragma once

#include <limits>

#include "camera/lens.h"
#include "camera/number.h"

namespace petzval {

enum class Towards { Film, Scene };
/// Whether semi-diameters stop light; the iris has one as well.
enum class Clip { Yes, No };
/// What became of a ray. Each surface asks in this order: missed, vignetted, totally reflected.
enum class Fate : int { Passed, Vignetted, TotallyReflected, Missed };

/// The surfaces to march through, both included, first on the scene's side whatever the direction;
/// nothing is done where last < first.
struct SurfaceRange {
    int first = 0, last = 0;
};

/// Millimetres; the direction has unit length (in floats within 1e-6, less where light grazes a
/// surface) and says where light is followed to, z towards the film. z of the origin counts from
/// the vertex of a surface, so that no digits are lost on the length of the lens: the last one that
/// was met.
///
/// Lanes that are blocked keep their fate, and go on along the axis, where nothing can go wrong.
template <class N>
struct LensRay {
    Vec3<N> origin, direction;
    int counted_from = 0;     ///< the surface from whose vertex z of the origin counts
    CodeOf<N> fate_code{};    ///< Fate, as a number
    CodeOf<N> end_surface{};  ///< where a blocked lane ended

    [[nodiscard]] MaskOf<N> alive() const { return fate_code == 0; }
    [[nodiscard]] Fate fate(int i) const { return Fate(lane(fate_code, i)); }
};

/// What an observer is told at each surface, before light is refracted there.
template <class N>
struct LensHit {
    int surface;
    Vec3<N> point;      ///< counted from this surface's vertex
    N distance_mm;      ///< from the point before
    ValueOf<N> index;   ///< of the medium on the way
    MaskOf<N> reached;  ///< lanes for which the above is true: blocked here at most
};

struct NoObserver {
    void operator()(const auto&) const {}
};

namespace lens_march {

/// Where a ray meets a surface. normal: unit, along the light that crosses the surface. The cosine
/// of incidence and its square, as the square is there before the root.
template <class N>
struct Meeting {
    N distance;
    Vec3<N> point, normal;
    N cosine, cosine2;
    MaskOf<N> found;
};

template <class N>
[[nodiscard]] N or_zero(N a) {
    return select(value_of(a) > 0, a, N{});
}

/// The root of a t^2 + 2 b t + c = 0 at which a t + b = -root, where root^2 = b^2 - a c: in that
/// one of its two forms in which nothing cancels.
template <class N>
[[nodiscard]] N root_of(N a, N b, N c, N root) {
    const auto same_sign = value_of(b) * value_of(root) <= 0;
    return select(same_sign, c, -b - root) / select(same_sign, root - b, a);
}

/// `foot` is the ray's point that is nearest to the vertex: from there the root has no large terms
/// that cancel, wherever the ray came from, and B is -direction.z (Feder 1951, J. Opt. Soc. Am. 41,
/// 630); it halves what floats err, for the same time. The root is the one on the sheet that has
/// the vertex, crossed in the light's direction.
template <class N>
[[nodiscard]] Meeting<N> meet_sphere(ScalarOf<N> c, ScalarOf<N> sign, const Vec3<N>& foot,
                                     const Vec3<N>& direction) {
    const N beyond = c * dot(foot, foot) - 2 * foot.z;
    Meeting<N> hit;
    hit.cosine2 = direction.z * direction.z - c * beyond;
    hit.cosine = sqrt(or_zero(hit.cosine2));
    hit.distance =
        root_of<N>(constant<N>(broadcast<ValueOf<N>>(c)), -direction.z, beyond, sign * hit.cosine);
    hit.point = foot + direction * hit.distance;
    const N sheet = 1 - c * hit.point.z;
    hit.found = (value_of(hit.cosine2) >= 0) & (value_of(sheet) > 0);
    hit.normal = {hit.point.x * (-sign * c), hit.point.y * (-sign * c), sheet * sign};
    return hit;
}

/// The same for curvature_x x^2 + curvature_y y^2 + curvature_z z^2 = 2 z, whose gradient is not
/// of unit length.
template <class N>
[[nodiscard]] Meeting<N> meet_quadric(const SurfaceFacts<ScalarOf<N>>& s, ScalarOf<N> sign,
                                      const Vec3<N>& foot, const Vec3<N>& direction) {
    const auto curved = [&s](const Vec3<N>& a) {
        return Vec3<N>{a.x * s.curvature_x, a.y * s.curvature_y, a.z * s.curvature_z};
    };
    const N a = dot(curved(direction), direction);
    const N b = dot(curved(direction), foot) - direction.z;
    const N c = dot(curved(foot), foot) - 2 * foot.z;
    const N discriminant = b * b - a * c;
    const N root = sqrt(or_zero(discriminant));
    Meeting<N> hit;
    hit.distance = root_of<N>(a, b, c, sign * root);
    hit.point = foot + direction * hit.distance;
    const N sheet = 1 - s.curvature_z * hit.point.z;
    hit.found = (value_of(discriminant) >= 0) & (value_of(sheet) > 0);
    const Vec3<N> along{hit.point.x * (-s.curvature_x), hit.point.y * (-s.curvature_y), sheet};
    hit.normal = along * (sign / sqrt(dot(along, along)));
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

/// Newton's method from the quadric's point. Each lane stops when it has converged, so that what
/// it finds does not depend on its neighbours. The last step, in N, squares what error is left
/// and brings the derivatives: those of an implicit function.
template <class N>
[[nodiscard]] Meeting<N> meet_asphere(const SurfaceFacts<ScalarOf<N>>& facts,
                                      const Asphere<ScalarOf<N>>& s, ScalarOf<N> sign,
                                      const Vec3<N>& foot, const Vec3<N>& direction) {
    using V = ValueOf<N>;
    using S = ScalarOf<N>;
    constexpr int kIterations = 12;
    // Newton squares the relative error: after this, one step reaches the last digit.
    constexpr S kConverged = sizeof(S) == sizeof(float) ? S(1e-4) : S(1e-8);
    const auto r2_of = [&s](const auto& p) {
        return p.x * p.x * s.across_x + p.y * p.y * s.across_y;
    };
    const auto step = [&]<class M>(const Vec3<M>& p, const Vec3<M>& d, const Sag<M>& sag) {
        const V slope =
            value_of(d.z) - value_of(sag.slope_by_r) * (value_of(p.x) * value_of(d.x) * s.across_x +
                                                        value_of(p.y) * value_of(d.y) * s.across_y);
        return (sag.height - p.z) / slope;
    };
    const Vec3<V> from = value_of(foot), along = value_of(direction);
    V distance = meet_quadric<V>(facts, sign, from, along).distance;
    MaskOf<N> converged = distance != distance;
    for (int i = 0; i < kIterations && !all(converged); ++i) {
        const Vec3<V> p = from + along * distance;
        const V by = step(p, along, sag_at<V>(s, r2_of(p)));
        distance = select(converged, distance, distance + by);
        const V size2 = dot(p, p) + distance * distance;
        converged = converged | (by * by <= (kConverged * kConverged) * size2);
    }
    const Vec3<N> near = foot + direction * distance;
    Meeting<N> hit;
    hit.distance = step(near, direction, sag_at<N>(s, r2_of(near))) + distance;
    hit.point = foot + direction * hit.distance;
    const Sag<N> sag = sag_at<N>(s, r2_of(hit.point));
    const Vec3<N> ahead{hit.point.x * sag.slope_by_r * (-s.across_x),
                        hit.point.y * sag.slope_by_r * (-s.across_y), constant<N>(broadcast<V>(1))};
    hit.normal = ahead * (sign / sqrt(dot(ahead, ahead)));
    hit.cosine = dot(hit.normal, direction);
    hit.cosine2 = hit.cosine * hit.cosine;
    // An infinite slope makes no number of the cosine, one whose square is infinite makes it 0.
    hit.found = converged & (value_of(hit.cosine) > 0);
    return hit;
}

/// Lanes that are blocked just now get their fate; all blocked ones have the axis for a ray.
template <class N>
[[gnu::noinline]] LensRay<N> block(LensRay<N> ray, int surface, ScalarOf<N> sign, MaskOf<N> found,
                                   MaskOf<N> inside, MaskOf<N> refracted) {
    using Code = CodeOf<N>;
    const auto code = [](auto a) { return Code{} + static_cast<int>(a); };
    const MaskOf<N> fresh = ray.alive() & !(found & inside & refracted);
    const Code fate = select(!found, code(Fate::Missed),
                             select(!inside, code(Fate::Vignetted), code(Fate::TotallyReflected)));
    ray.fate_code = select(fresh, fate, ray.fate_code);
    ray.end_surface = select(fresh, code(surface), ray.end_surface);
    const MaskOf<N> on = ray.alive();
    const auto axis = constant<N>(broadcast<ValueOf<N>>(sign));
    ray.origin = select(on, ray.origin, Vec3<N>{});
    ray.direction = select(on, ray.direction, Vec3<N>{N{}, N{}, axis});
    return ray;
}

}  // namespace lens_march

/// Takes a ray through the surfaces of a range, from anywhere on its line: backwards along it to
/// the first surface is as good as forwards. It ends on the last surface, refracted. Returns the
/// lanes that passed. N: float, f4, d4, Dual<f4> or Dual<d4>; the observer is called with a
/// LensHit<N>.
///
/// Refraction in vector form (Welford 1986, Aberrations of Optical Systems, ch. 4). Any input has a
/// defined result; NaN misses.
template <class N, class Observer = NoObserver>
[[nodiscard]] MaskOf<N> march(const Lens& lens, const LensIndices<ValueOf<N>>& indices,
                              Towards towards, SurfaceRange range, LensRay<N>& marched, Clip clip,
                              const Observer& observe = {}) {
    using namespace lens_march;
    using V = ValueOf<N>;
    using S = ScalarOf<N>;
    const bool to_film = towards == Towards::Film;
    const S sign = to_film ? S(1) : S(-1);
    const SurfaceFacts<S>* const facts = lens.surfaces<S>().data();
    const int begin = to_film ? range.first : range.last;
    LensRay<N> ray = marched;
    if (range.first > range.last) return ray.alive();
    if (ray.counted_from != begin)
        ray.origin.z = ray.origin.z + S(lens.vertex_mm(ray.counted_from) - lens.vertex_mm(begin));
    for (int left = range.last - range.first, i = begin; left >= 0; --left, i += to_film ? 1 : -1) {
        const SurfaceFacts<S>& s = facts[i];
        ray.counted_from = i;
        if (i != begin) ray.origin.z = ray.origin.z - (to_film ? facts[i - 1].gap_mm : -s.gap_mm);
        const N to_foot = -dot(ray.origin, ray.direction);
        const Vec3<N> foot = ray.origin + ray.direction * to_foot;
        const Meeting<N> hit =
            s.shape == Shape::Sphere ? meet_sphere<N>(s.curvature_y, sign, foot, ray.direction)
            : s.shape == Shape::Quadric
                ? meet_quadric<N>(s, sign, foot, ray.direction)
                : meet_asphere<N>(s, lens.aspheres<S>()[s.asphere], sign, foot, ray.direction);
        ray.origin = hit.point;
        const V x = value_of(hit.point.x), y = value_of(hit.point.y);
        const MaskOf<N> inside =
            x * x + y * y <=
            (clip == Clip::Yes ? s.semi_diameter2_mm2 : std::numeric_limits<S>::infinity());
        const int from = to_film ? s.medium_before : s.medium_after;
        const int into = to_film ? s.medium_after : s.medium_before;
        observe(LensHit<N>{i, hit.point, hit.distance + to_foot, indices.of_medium[from],
                           MaskOf<N>(ray.alive() & hit.found)});
        MaskOf<N> refracted = !MaskOf<N>{};
        if (from != into) {
            const V ratio = indices.of_medium[from] / indices.of_medium[into];
            const N cosine2 = 1 - ratio * ratio * (1 - hit.cosine2);
            refracted = value_of(cosine2) >= 0;
            ray.direction =
                ray.direction * ratio + hit.normal * (sqrt(or_zero(cosine2)) - hit.cosine * ratio);
        }
        if (!all(hit.found & inside & refracted)) [[unlikely]] {
            ray = block(ray, i, sign, hit.found, inside, refracted);
            if (!any(ray.alive())) break;
        }
    }
    marched = ray;
    return ray.alive();
}

}  // namespace petzval
